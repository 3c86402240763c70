#include "app/render/log/past_launches.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "app/host/command_line.h"
#include "app/render/log/journal.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

bool is_to_make(const Json& launch, const std::string& video) {
  if (!launch.is_object()) return false;
  const std::string line = launch.value("command_line", "") + " ";
  const std::array<std::string, 2> apart{"--video", video};
  const std::array<std::string, 1> together{"--video=" + video};
  return line.find(" " + shell_line(apart) + " ") != std::string::npos ||
         line.find(" " + shell_line(together) + " ") != std::string::npos;
}

}  // namespace

bool was_to_make(const RunFolder& folder, const std::string& video) {
  Json launches = Json::array();
  if (const auto journal = read_journal(folder.journal())) {
    for (const Json& line : journal->lines) {
      if (line.contains("launch")) launches.push_back(line["launch"]);
    }
  }
  if (std::filesystem::exists(folder.record())) {
    const auto bytes = base::read_file(folder.record().string());
    const Json record = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    if (!record.is_object()) return false;
    for (const Json& launch : record.value("launches", Json::array())) launches.push_back(launch);
  }
  return std::ranges::any_of(launches,
                             [&](const Json& launch) { return is_to_make(launch, video); });
}

}  // namespace pneuma::app
