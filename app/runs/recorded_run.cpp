#include "app/runs/recorded_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "app/render/log/run_record.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> journals_in(const fs::path& folder) {
  std::vector<fs::path> journals;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".journal") journals.push_back(entry.path());
  }
  return journals;
}

Json unfinished_record(const fs::path& folder) {
  const std::vector<fs::path> journals = journals_in(folder);
  if (journals.size() != 1) {
    throw base::IoError(fmt::format(
        "{} holds {}; name the folder of one `pneuma render`", folder.string(),
        journals.empty() ? "no run" : fmt::format("{} unfinished runs", journals.size())));
  }
  const auto contents = read_journal(journals.front());
  if (!contents) {
    throw base::IoError(
        fmt::format("{}: its first line is torn; render the run again", journals.front().string()));
  }
  return whole_record(*contents);
}

Json record_in(const fs::path& folder) {
  const fs::path file = folder / "run.json";
  if (!fs::exists(file)) return unfinished_record(folder);
  try {
    return Json::parse(base::read_text_file(file.string()));
  } catch (const Json::exception& error) {
    throw base::IoError(
        fmt::format("{} cannot be read ({}); render the run again", file.string(), error.what()));
  }
}

bool is_control_character(char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }

/// Files are called after the scene, and a record may come from anybody.
void check_scene_name(const fs::path& folder, const std::string& name) {
  const bool names_a_file = !name.empty() && name != "." && name != ".." &&
                            name.find('/') == std::string::npos &&
                            std::ranges::none_of(name, is_control_character);
  if (names_a_file) return;
  throw base::IoError(fmt::format(
      "the record in {}: run.scene is {}; allowed is a file's name without control characters; "
      "render the run again",
      folder.string(), Json(name).dump(-1, ' ', true, Json::error_handler_t::replace)));
}

/// What every look at a run relies on.
void check_record(const fs::path& folder, const Json& record) {
  try {
    check_scene_name(folder, record.at("run").at("scene").get<std::string>());
    record.at("scene_toml").get_ref<const std::string&>();
    for (const Json& frame : record.at("frames")) {
      frame.at("frame").get<std::int64_t>();
      frame.at("time").get<double>();
      frame.at("state_hash").get_ref<const std::string&>();
      frame.at("energy").at("total");
      frame.at("volumes");
      frame.at("contacts").at("count").get<std::int64_t>();
      frame.at("greatest_penetration");
      frame.at("seconds");
    }
    if (record.at("frames").empty()) throw base::IoError(folder.string() + " has no frame yet");
  } catch (const Json::exception& error) {
    throw base::IoError(
        fmt::format("the record in {} is not one of this program's ({}); render the run again",
                    folder.string(), error.what()));
  }
}

}  // namespace

RecordedRun read_run(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw base::IoError(
        fmt::format("{} is not a folder; name the folder of a `pneuma render`", folder.string()));
  }
  Json record = record_in(folder);
  check_record(folder, record);
  const auto name = record["run"]["scene"].get<std::string>();
  return {RunFolder(folder, name), std::move(record)};
}

}  // namespace pneuma::app
