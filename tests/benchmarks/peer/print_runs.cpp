#include "benchmarks/peer/print_runs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/terminal/table.h"
#include "benchmarks/peer/bullet_settings.h"
#include "benchmarks/peer/peer_build.h"

namespace pneuma::benchmarks {
namespace {

using app::readable;
using Align = app::Table::Align;

std::string times(double ratio) { return fmt::format("{:.2f}x", ratio); }

std::string microseconds(const SideResult& side) {
  const int steps = side.steps_per_second / 60;
  const std::string text = readable(1e6 * side.frame_seconds());
  return steps > 1 ? fmt::format("{} ({} steps)", text, steps) : text;
}

std::string times_text(const std::vector<PairedRun>& runs) {
  app::Table table({{"scene", Align::left},
                    {"Bullet", Align::right, "us per 1/60 s"},
                    {"rk4", Align::right, "us per 1/60 s"},
                    {"verlet", Align::right, "us per 1/60 s"},
                    {"rk4", Align::right, "Bullet takes"},
                    {"verlet", Align::right, "Bullet takes"},
                    {"Bullet", Align::right, "contacts"},
                    {"rk4", Align::right, "contacts"},
                    {"Bullet simulates", Align::left}});
  for (const PairedRun& run : runs) {
    const double bullet = run.bullet.frame_seconds();
    table.add_row({run.name, microseconds(run.bullet), microseconds(run.rk4),
                   microseconds(run.velocity_verlet), times(bullet / run.rk4.frame_seconds()),
                   times(bullet / run.velocity_verlet.frame_seconds()),
                   readable(run.bullet.contacts_per_step), readable(run.rk4.contacts_per_step),
                   verdict(run.bullet.quality, run.rk4.quality)});
  }
  return table.text();
}

std::string qualities_text(const std::vector<PairedRun>& runs) {
  std::vector<app::Table::Column> columns = {{"scene", Align::left}};
  for (const char* group : {"V end / V start", "m/s at the end", "deepest, m", "crossings"}) {
    for (const char* side : {"Bullet", "rk4", "verlet"}) {
      columns.push_back({side, Align::right, group});
    }
  }
  app::Table table(columns);
  for (const PairedRun& run : runs) {
    std::vector<std::string> cells = {run.name};
    const auto add = [&](const auto& cell) {
      for (const SideResult* side : {&run.bullet, &run.rk4, &run.velocity_verlet}) {
        cells.push_back(cell(side->quality));
      }
    };
    add([](const Quality& quality) { return readable(quality.inflation); });
    add([](const Quality& quality) { return fmt::format("{:.3f}", quality.end_speed); });
    add([](const Quality& quality) { return fmt::format("{:.4f}", quality.deepest); });
    add([](const Quality& quality) { return std::to_string(quality.crossings); });
    table.add_row(cells);
  }
  return table.text();
}

std::string settings_text(const std::vector<PairedRun>& runs) {
  app::Table table({{"scene", Align::left}, {"Bullet's setting", Align::left}});
  for (const PairedRun& run : runs) table.add_row({run.name, setting_text(run.bullet_options)});
  return table.text();
}

}  // namespace

std::string builds_text() {
  return fmt::format(
      "Ours: double precision, {}.\n"
      "Bullet: {}, single precision, {}.\n",
      our_flags, bullet_version, bullet_build());
}

std::string runs_text(const std::vector<PairedRun>& runs) {
  return fmt::format("{}\n{}\n{}", times_text(runs), qualities_text(runs), settings_text(runs));
}

std::string verdict(const Quality& peer, const Quality& ours) {
  std::vector<std::string> missed;
  if (!inflates_like(peer, ours)) missed.emplace_back("inflation");
  if (!rests_like(peer, ours)) missed.emplace_back("rest");
  if (!keeps_apart_like(peer, ours)) missed.emplace_back("depth");
  return missed.empty() ? "as ours" : fmt::format("not our {}", fmt::join(missed, ", "));
}

std::string search_text(const std::string& scene, const SettingSearch& search) {
  const bool found = !search.reaching.empty();
  app::Table table({{"setting", Align::left},
                    {"us per\n1/60 s"},
                    {"V end /\nV start"},
                    {"m/s at\nthe end"},
                    {"deepest,\nm"},
                    {"crossings"},
                    {"simulates", Align::left}});
  const auto add = [&](const std::string& setting, const Trial& trial) {
    const Quality& quality = trial.quality;
    table.add_row({setting, readable(1e6 * trial.frame_seconds), readable(quality.inflation),
                   fmt::format("{:.3f}", quality.end_speed), fmt::format("{:.4f}", quality.deepest),
                   std::to_string(quality.crossings), verdict(quality, search.ours.quality)});
  };
  add("ours, rk4", search.ours);
  for (const Candidate& one : found ? search.reaching : search.nearest) {
    add(setting_text(one.options), one.trial);
  }
  return fmt::format(
      "{}: {} of Bullet's settings tried, {}.\n\n{}", scene, search.tried,
      found ? "the cheapest that simulate it as ours" : "none simulates it as ours; the nearest",
      table.text());
}

}  // namespace pneuma::benchmarks
