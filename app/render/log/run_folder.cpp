#include "app/render/log/run_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <limits>
#include <optional>
#include <regex>
#include <set>
#include <utility>

#include "app/render/log/journal.h"
#include "app/render/log/run_record.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what, const std::error_code& error,
                       const std::string& advice) {
  throw base::IoError(fmt::format("{}: {}; {}", what, error.message(), advice));
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  if (error) {
    fail(fmt::format("cannot read the folder {}", folder.string()), error,
         "choose another with --out");
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A run as its record or journal says.
struct RecordedRun {
  std::string name;
  std::int64_t first = 0, last = -1;  // frames
};

/// Of a header as run.json and journals have it; none when it is none of ours.
std::optional<RecordedRun> run_of(const Json& header) {
  const Json run = header.is_object() ? header.value("run", Json()) : Json();
  const Json scene = run.is_object() ? run.value("scene", Json()) : Json();
  if (!scene.is_string() || scene.get<std::string>().empty()) return std::nullopt;
  const auto frame = [&](const char* key, std::int64_t otherwise) {
    return run.contains(key) && run[key].is_number_integer() ? run[key].get<std::int64_t>()
                                                             : otherwise;
  };
  return RecordedRun{scene.get<std::string>(), frame("first_frame", 0), frame("last_frame", -1)};
}

RecordedRun run_of_record(const fs::path& record) {
  const auto bytes = base::read_file(record.string());
  const auto run = run_of(Json::parse(bytes.begin(), bytes.end(), nullptr, false));
  if (run) return *run;
  throw base::IoError(fmt::format("{} is not the record of a run; choose another folder with --out",
                                  record.string()));
}

std::optional<RecordedRun> run_of_journal(const fs::path& journal) {
  const auto contents = read_journal(journal);
  return contents ? run_of(present_header(*contents)) : std::nullopt;
}

std::vector<RecordedRun> recorded_runs(const RunFolder& folder) {
  std::vector<RecordedRun> runs;
  for (const std::string& file : files_in(folder.path())) {
    const fs::path path = folder.path() / file;
    if (path == folder.record()) runs.push_back(run_of_record(path));
    if (path.extension() != ".journal") continue;
    if (const auto run = run_of_journal(path)) runs.push_back(*run);
  }
  return runs;
}

/// What comes after the name of the run, as groups: "_00042.png" has the frame 00042.
bool is_ending_of_run(const std::string& ending, std::smatch& match) {
  static const std::regex endings(
      R"((?:_overlay)?_([0-9]{5,})\.png|_sheet\.png|\.journal|\.state)");
  return std::regex_match(ending, match, endings);
}

/// Of a file of the run; none of one that is no frame, or of a number that no frame has.
std::optional<std::int64_t> frame_in(const std::string& file, const std::string& run) {
  std::smatch match;
  const std::string ending = file.substr(run.size());
  if (!is_ending_of_run(ending, match) || !match[1].matched) return std::nullopt;
  std::int64_t frame = 0;
  const std::string digits = match[1].str();
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), frame);
  return read.ec == std::errc() ? frame : std::numeric_limits<std::int64_t>::max();
}

/// Whether the run made the file. What is half written is never anyone else's.
bool made(const RecordedRun& run, const std::string& file) {
  if (!is_file_of_run(file, run.name)) return false;
  const auto frame = frame_in(file, run.name);
  return !frame || (run.first <= *frame && *frame <= run.last);
}

void remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) {
    fail(fmt::format("cannot remove {}", path.string()), error,
         "remove it yourself or choose another folder with --out");
  }
}

}  // namespace

std::string without_temporary_ending(const std::string& file) {
  static const std::regex pattern(R"((.+)\.[0-9]+-[0-9]+\.tmp)");
  std::smatch match;
  return std::regex_match(file, match, pattern) ? match[1].str() : "";
}

bool is_file_of_run(const std::string& file, const std::string& run) {
  const std::string whole = without_temporary_ending(file);
  const std::string& name = whole.empty() ? file : whole;
  if (!name.starts_with(run)) return false;
  std::smatch match;
  const std::string ending = name.substr(run.size());
  return is_ending_of_run(ending, match);
}

RunFolder::RunFolder(fs::path folder, std::string name)
    : folder_(std::move(folder)), name_(std::move(name)) {}

fs::path RunFolder::frame(std::int64_t index) const {
  return folder_ / fmt::format("{}_{:05}.png", name_, index);
}

fs::path RunFolder::overlay(std::int64_t index) const {
  return folder_ / fmt::format("{}_overlay_{:05}.png", name_, index);
}

void RunFolder::make() const {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_, error)) {
    if (!error) error = std::make_error_code(std::errc::not_a_directory);
    fail(fmt::format("cannot make the folder {}", folder_.string()), error,
         "choose another with --out");
  }
  if (access(folder_.c_str(), W_OK | X_OK) != 0) {
    fail(fmt::format("cannot write to the folder {}", folder_.string()),
         std::error_code(errno, std::generic_category()), "choose another with --out");
  }
}

std::vector<std::string> RunFolder::runs() const {
  std::set<std::string> names;
  for (const RecordedRun& run : recorded_runs(*this)) names.insert(run.name);
  return {names.begin(), names.end()};
}

std::vector<std::string> RunFolder::pictures() const {
  std::vector<std::string> names = files_in(folder_);
  std::erase_if(names, [&](const std::string& file) {
    return !is_file_of_run(file, name_) || !file.ends_with(".png");
  });
  return names;
}

void RunFolder::remove_runs() const {
  for (const RecordedRun& run : recorded_runs(*this)) {
    const RunFolder old(folder_, run.name);
    for (const std::string& file : files_in(folder_)) {
      if (made(run, file) && folder_ / file != old.journal()) remove_file(folder_ / file);
    }
    // Last of all, because they say whose the other files are if this is interrupted.
    remove_file(old.journal());
  }
  remove_file(record());
  remove_temporary_files();
}

void RunFolder::remove_temporary_files() const {
  for (const std::string& file : files_in(folder_)) {
    const std::string whole = without_temporary_ending(file);
    if (whole.empty()) continue;
    if (is_file_of_run(whole, name_) || whole == record().filename()) remove_file(folder_ / file);
  }
}

}  // namespace pneuma::app
