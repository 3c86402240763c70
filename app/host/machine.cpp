#include "app/host/machine.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/utsname.h>

#include <fstream>

namespace pneuma::app {
namespace {

/// The rest of the first line that starts with `key` and has `separator` after it.
std::string value_in(const char* path, const std::string& key, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, key.size(), key) != 0) continue;
    const std::size_t at = line.find(separator);
    if (at == std::string::npos) continue;
    const std::size_t begin = line.find_first_not_of(" \t\"", at + 1);
    const std::size_t end = line.find_last_not_of(" \t\"");
    return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
  }
  return "";
}

int usable_cores() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return CPU_COUNT(&set);
}

}  // namespace

Machine machine() {
  Machine result;
  result.cpu = value_in("/proc/cpuinfo", "model name", ':');
  if (result.cpu.empty()) result.cpu = "unknown";
  result.cores = usable_cores();
  const std::string system = value_in("/etc/os-release", "PRETTY_NAME", '=');
  utsname name{};
  if (uname(&name) == 0) result.os = fmt::format("{} {}", name.sysname, name.release);
  if (!system.empty()) result.os = fmt::format("{}, {}", system, result.os);
  return result;
}

}  // namespace pneuma::app
