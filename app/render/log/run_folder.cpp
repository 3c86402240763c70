#include "app/render/log/run_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <regex>
#include <set>
#include <utility>

#include "app/render/log/journal.h"
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

/// The scene of a header as run.json and journals have it; empty when it is none of ours.
std::string scene_of(const Json& header) {
  const Json run = header.is_object() ? header.value("run", Json()) : Json();
  const Json scene = run.is_object() ? run.value("scene", Json()) : Json();
  return scene.is_string() ? scene.get<std::string>() : "";
}

std::string scene_of_record(const fs::path& record) {
  const auto bytes = base::read_file(record.string());
  const std::string scene = scene_of(Json::parse(bytes.begin(), bytes.end(), nullptr, false));
  if (scene.empty()) {
    throw base::IoError(fmt::format(
        "{} is not the record of a run; choose another folder with --out", record.string()));
  }
  return scene;
}

std::string scene_of_journal(const fs::path& journal) {
  const auto contents = read_journal(journal);
  return contents ? scene_of(contents->header) : "";
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
  static const std::regex endings(R"((_overlay)?_[0-9]{5,}\.png|_sheet\.png|\.journal|\.state)");
  const std::string whole = without_temporary_ending(file);
  const std::string& name = whole.empty() ? file : whole;
  return name.starts_with(run) && std::regex_match(name.substr(run.size()), endings);
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
  for (const std::string& file : files_in(folder_)) {
    const fs::path path = folder_ / file;
    if (path.extension() == ".journal") names.insert(scene_of_journal(path));
    if (path == record()) names.insert(scene_of_record(path));
    if (is_file_of_run(file, name_) && without_temporary_ending(file).empty()) names.insert(name_);
  }
  names.erase("");
  return {names.begin(), names.end()};
}

void RunFolder::remove_runs() const {
  for (const std::string& run : runs()) {
    const RunFolder old(folder_, run);
    for (const std::string& file : files_in(folder_)) {
      if (is_file_of_run(file, run) && folder_ / file != old.journal()) remove_file(folder_ / file);
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
