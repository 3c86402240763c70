#include "app/record/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

namespace pneuma::app {

std::string utc_date() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

nlohmann::json provenance_json() {
  return {{"machine", machine_json()}, {"program", program_json()}};
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
