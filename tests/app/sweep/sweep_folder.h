// A small sweep in a folder of its own: two springs times three amounts of gas of a ball that
// falls.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {

inline constexpr const char* short_fall = R"(
duration = 0.2
[picture]
width = 64
height = 48
samples = 1
[[body]]
name = "ball"
radius = 1.0
position = [0.0, 0.0, 1.2]
)";

inline constexpr const char* six_runs = R"(scenes = ["fall.toml"]
measure = ["energy", "volume", "state_hash"]
[[parameter]]
key = "body.k"
values = [50, 80]
[[parameter]]
key = "body.n"
log_range = [0.1, 10]
count = 3
)";

class SweepFolder : public testing::Test {
 protected:
  SweepFolder() {
    write_text(folder_ / "fall.toml", short_fall);
    write_text(file(), six_runs);
  }

  std::filesystem::path file() const { return folder_ / "six.toml"; }
  std::filesystem::path out(const std::string& name = "out") const { return folder_ / name; }

  ProgramResult sweep(const std::string& options, const std::string& into = "out") const {
    return run_pneuma(fmt::format("sweep '{}' --quiet --out '{}' {} 2>&1", file().string(),
                                  out(into).string(), options));
  }

  TemporaryFolder folder_;
};

}  // namespace pneuma
