// Whether times measured here and now mean anything.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pneuma::app {

struct TimingConditions {
  bool debug_build = false;
  std::string build;           // what is slow about it
  std::optional<double> load;  // processes that wanted to run during the last minute, mean
  int cores = 1;
  std::optional<std::string> governor;  // of the clock speed of core 0; none where it is not known
};

/// Look before measuring: what is measured is itself part of the load.
TimingConditions timing_conditions();

/// One sentence per reason for doubt.
std::vector<std::string> timing_warnings(const TimingConditions& conditions);

}  // namespace pneuma::app
