#include "app/record/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "app/host/machine.h"
#include "app/host/version.h"

namespace pneuma::app {

std::string utc_date() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

nlohmann::json provenance_json() {
  const Machine here = machine();
  const Version built = version();
  return {{"machine", {{"cpu", here.cpu}, {"cores", here.cores}, {"os", here.os}}},
          {"program",
           {{"version", built.program},
            {"commit", built.commit},
            {"compiler", built.compiler},
            {"build_type", built.build_type},
            {"flags", built.flags}}}};
}

std::string provenance_text(const std::string& date) {
  const Machine here = machine();
  const Version built = version();
  return fmt::format("Machine: {}, {} core{}, {}.\nProgram: pneuma {}{}, {} {}, {}. {}.\n",
                     here.cpu, here.cores, here.cores == 1 ? "" : "s", here.os, built.program,
                     built.commit.empty() ? "" : " (" + built.commit + ")", built.compiler,
                     built.build_type, built.flags, date);
}

}  // namespace pneuma::app
