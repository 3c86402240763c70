#include "app/host/timing_conditions.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <fstream>

#include "app/host/machine.h"
#include "app/host/version.h"

namespace pneuma::app {
namespace {

// Beyond, another process is likely to share the core with what is measured.
constexpr double busy_load_per_core = 0.5;

// Without it Eigen checks every index.
#ifdef NDEBUG
constexpr bool asserts = false;
#else
constexpr bool asserts = true;
#endif

std::optional<std::string> first_word(const std::string& path) {
  std::ifstream file(path);
  std::string word;
  if (file >> word) return word;
  return std::nullopt;
}

}  // namespace

TimingConditions timing_conditions() {
  TimingConditions conditions;
  const Version built = version();
  conditions.debug_build = is_debug_build() || asserts;
  conditions.build =
      fmt::format("{}{}{}", built.build_type, built.flags.empty() ? "" : " ", built.flags);
  double load = 0.0;
  if (getloadavg(&load, 1) == 1) conditions.load = load;
  conditions.cores = machine().cores;
  conditions.governor = first_word("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  return conditions;
}

std::vector<std::string> timing_warnings(const TimingConditions& conditions) {
  std::vector<std::string> warnings;
  if (conditions.debug_build) {
    warnings.push_back(fmt::format(
        "this is a debug or sanitizer build ({}): its times say nothing; configure with "
        "-DCMAKE_BUILD_TYPE=Release -DPNEUMA_SANITIZE=",
        conditions.build));
  }
  if (conditions.load && *conditions.load > busy_load_per_core * conditions.cores) {
    warnings.push_back(fmt::format(
        "the machine is busy: {:.1f} processes wanted to run during the last minute, on "
        "{} cores; measure again when it is idle",
        *conditions.load, conditions.cores));
  }
  if (conditions.governor && *conditions.governor != "performance") {
    warnings.push_back(
        fmt::format("the processor's clock speed follows the governor '{}'; for steady times: sudo "
                    "cpupower frequency-set -g performance",
                    *conditions.governor));
  }
  return warnings;
}

}  // namespace pneuma::app
