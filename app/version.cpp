#include "app/version.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "app/build_info.h"

namespace pneuma::app {

Version version() {
  return {PNEUMA_VERSION, PNEUMA_COMMIT, PNEUMA_COMPILER, PNEUMA_BUILD_TYPE, PNEUMA_FLAGS};
}

bool is_debug_build() {
#ifdef __OPTIMIZE__
  return std::string(PNEUMA_FLAGS).find("-fsanitize") != std::string::npos;
#else
  return true;
#endif
}

std::vector<std::pair<std::string, std::string>> library_versions() {
  return {
      {"Eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"fmt",
       fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                    NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
      {"CLI11", CLI11_VERSION},
      {"libdeflate", LIBDEFLATE_VERSION_STRING},
  };
}

}  // namespace pneuma::app
