// This very program.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

namespace pneuma::app {

/// The path of the program that runs.
inline std::string own_program() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).string();
}

}  // namespace pneuma::app
