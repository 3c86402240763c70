#include "app/runs/recorded_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "app/render/log/run_record.h"
#include "sim/base/file.h"
#include "sim/base/nearest.h"

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

/// `byte`: as the parser has it, counted from 1, of the last that it has read.
[[noreturn]] void refuse_damaged(const fs::path& file, const std::string& text, std::size_t byte) {
  const std::size_t at = std::min(byte > 0 ? byte - 1 : 0, text.size());
  const std::string_view before = std::string_view(text).substr(0, at);
  const auto line = 1 + std::ranges::count(before, '\n');
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  const std::string what =
      at == text.size() ? "the file ends here, within the record"
                        : fmt::format("{} is not what a record has here",
                                      base::in_quotes(std::string_view(text).substr(at, 20)));
  throw base::IoError(
      fmt::format("{}:{}:{}: {}; the file is damaged and cannot be read: put a copy of it in its "
                  "place, or render the run again with --overwrite",
                  file.string(), line, at - line_start + 1, what));
}

Json record_in(const fs::path& folder) {
  const fs::path file = folder / "run.json";
  if (!fs::exists(file)) return unfinished_record(folder);
  const std::string text = base::read_text_file(file.string());
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    refuse_damaged(file, text, error.byte);
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
  std::string place = "run.scene";
  try {
    check_scene_name(folder, record.at("run").at("scene").get<std::string>());
    place = "scene_toml";
    record.at("scene_toml").get_ref<const std::string&>();
    place = "frames";
    const Json& frames = record.at("frames");
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const Json& frame = frames.at(i);
      const auto go_to = [&](const char* key) { place = fmt::format("frames[{}].{}", i, key); };
      go_to("frame");
      frame.at("frame").get<std::int64_t>();
      go_to("time");
      frame.at("time").get<double>();
      go_to("state_hash");
      frame.at("state_hash").get_ref<const std::string&>();
      go_to("energy.total");
      frame.at("energy").at("total");
      go_to("volumes");
      frame.at("volumes");
      go_to("contacts.count");
      frame.at("contacts").at("count").get<std::int64_t>();
      go_to("greatest_penetration");
      frame.at("greatest_penetration");
      go_to("seconds");
      frame.at("seconds");
    }
    if (frames.empty()) throw base::IoError(folder.string() + " has no frame yet");
  } catch (const Json::exception&) {
    throw base::IoError(fmt::format(
        "the record in {} is not one of this program's: {} is missing or of another kind; render "
        "the run again",
        folder.string(), place));
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
