#include "app/render/log/past_launches.h"

#include <algorithm>
#include <filesystem>

#include "app/render/log/journal.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

bool is_to_make(const Json& launch, const std::string& path) {
  const auto video = launch.find("video");
  return video != launch.end() && *video == path;
}

/// Of a record that is damaged, none.
Json launches_of(const RunFolder& folder) {
  Json launches = Json::array();
  if (const auto journal = read_journal(folder.journal())) {
    for (const Json& line : journal->lines) {
      if (line.contains("launch")) launches.push_back(line["launch"]);
    }
  }
  if (!std::filesystem::exists(folder.record())) return launches;
  const auto bytes = base::read_file(folder.record().string());
  const Json record = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (!record.is_object()) return launches;
  for (const Json& launch : record.value("launches", Json::array())) launches.push_back(launch);
  return launches;
}

}  // namespace

std::string whole_path(const std::string& video) {
  namespace fs = std::filesystem;
  return video.empty() ? "" : fs::weakly_canonical(fs::absolute(video)).string();
}

bool was_to_make(const RunFolder& folder, const std::string& video) {
  const std::string path = whole_path(video);
  return std::ranges::any_of(launches_of(folder),
                             [&](const Json& launch) { return is_to_make(launch, path); });
}

}  // namespace pneuma::app
