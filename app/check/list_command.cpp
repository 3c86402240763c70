// pneuma list: the scenes that come with the program.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/files/scene_catalogue.h"
#include "app/terminal/command.h"
#include "app/terminal/common_options.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

using Align = Table::Align;

// With these the table fits 120 columns.
constexpr std::size_t figure_width = 32;
constexpr std::size_t title_width = 46;

/// INVALID: an error, in place of a title.
std::string title_of(const CatalogueEntry& entry) {
  return wrapped(entry.error.empty() ? entry.title : "INVALID: " + entry.error, title_width);
}

std::string of_paper_text(const std::vector<CatalogueEntry>& entries) {
  Table table({{"scene", Align::left},
               {"the paper's figure or row", Align::left},
               {"paper\nfps", Align::right},
               {"title", Align::left}});
  for (const CatalogueEntry& entry : entries) {
    if (entry.figure.empty()) continue;
    table.add_row({entry.name, wrapped(entry.figure, figure_width),
                   entry.paper_fps ? fmt::format("{:g}", *entry.paper_fps) : "-", title_of(entry)});
  }
  return table.text();
}

std::string others_text(const std::vector<CatalogueEntry>& entries, bool with_flow_or_springs) {
  Table table({{"scene", Align::left}, {"title", Align::left}});
  for (const CatalogueEntry& entry : entries) {
    if (!entry.figure.empty() || entry.has_flow_or_springs != with_flow_or_springs) continue;
    table.add_row({entry.name, title_of(entry)});
  }
  return table.text();
}

std::string list_text(const std::vector<CatalogueEntry>& entries) {
  return of_paper_text(entries) + "\nBodies that are held or moved, and models:\n\n" +
         others_text(entries, false) +
         "\nGas that comes and goes, and bodies that springs join:\n\n" +
         others_text(entries, true);
}

nlohmann::json list_json(const std::vector<CatalogueEntry>& entries) {
  nlohmann::json list = nlohmann::json::array();
  for (const CatalogueEntry& entry : entries) {
    nlohmann::json item = {{"scene", entry.name},  {"path", entry.path.string()},
                           {"title", entry.title}, {"figure", entry.figure},
                           {"paper_fps", nullptr}, {"error", nullptr}};
    if (entry.paper_fps) item["paper_fps"] = *entry.paper_fps;
    if (!entry.error.empty()) item["error"] = entry.error;
    list.push_back(std::move(item));
  }
  return list;
}

}  // namespace

void add_list_command(CLI::App& app, Action& action) {
  auto json = std::make_shared<bool>(false);
  auto sweeps = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("list", "List the scenes with the paper's figures");
  command->add_flag("--json", *json, "Print JSON");
  command->add_flag("--sweeps", *sweeps, "Only the names of the sweeps that come with the program")
      ->excludes("--json");
  add_examples(*command, {"pneuma list", "pneuma list --json", "pneuma list --sweeps"});
  command->callback([json, sweeps, &action] {
    action = [json, sweeps] {
      if (*sweeps) {
        for (const std::string& name : sweep_names()) fmt::print("{}\n", name);
        return ExitCode::done;
      }
      const std::vector<CatalogueEntry> entries = scene_catalogue();
      fmt::print("{}", *json ? list_json(entries).dump(2) + "\n" : list_text(entries));
      return ExitCode::done;
    };
  });
}

}  // namespace pneuma::app
