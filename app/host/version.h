// What this program was built from, and with.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pneuma::app {

struct Version {
  std::string program;     // "0.1.0"
  std::string commit;      // of the sources, empty when they were not a git checkout
  std::string compiler;    // "GNU 12.2.0"
  std::string build_type;  // "Release"
  std::string flags;       // instruction set and sanitizers
};

Version version();

/// A build without optimisation or with sanitizers: its times say nothing.
bool is_debug_build();

/// For people, in several lines; with the Mesa that draws here, or why nothing can be drawn.
std::string version_text();

/// Name and version of each library.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace pneuma::app
