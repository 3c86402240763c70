// Every extreme case comes to what was expected of it, with an explicit and with both implicit
// integrators; and what is called valid is looked at, not assumed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <ostream>

#include "app/study/extreme/extreme_run.h"

namespace pneuma::app {
namespace {

struct Run {
  ExtremeCase extreme;
  std::string integrator;
  bool implicit;
};

void PrintTo(const Run& run, std::ostream* out) {
  *out << run.extreme.name << " " << run.integrator;
}

std::vector<Run> all_runs(bool large) {
  std::vector<Run> runs;
  for (const ExtremeCase& extreme : extreme_cases()) {
    if (extreme.large != large) continue;
    for (const auto& [integrator, implicit] : extreme_integrators) {
      runs.push_back({extreme, integrator, implicit});
    }
  }
  return runs;
}

std::string run_name(const testing::TestParamInfo<Run>& info) {
  std::string name = info.param.extreme.name + "_" + info.param.integrator;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

class Extreme : public testing::TestWithParam<Run> {};

TEST_P(Extreme, ComesToWhatWasExpected) {
  const ExtremeResult result = run_extreme(GetParam().extreme, GetParam().integrator);
  EXPECT_TRUE(as_expected(GetParam().extreme, GetParam().implicit, result))
      << to_string(result.outcome) << ": " << result.message;
}

INSTANTIATE_TEST_SUITE_P(Cases, Extreme, testing::ValuesIn(all_runs(false)), run_name);
INSTANTIATE_TEST_SUITE_P(LargeCases, Extreme, testing::ValuesIn(all_runs(true)), run_name);

ExtremeCase sphere_case(const std::string& keys) {
  return {.name = "a case", .scene = "[[body]]\nposition = [0, 0, 3.5]\n" + keys, .seconds = 1.0};
}

TEST(ExtremeRun, SeesEnergyThatRises) {
  ExtremeResult result = run_extreme(sphere_case("n = 1.0\nrho_g = 0.0\n"), "rk4");
  EXPECT_TRUE(result.valid) << result.message;
  // Against a tolerance that nothing meets: it must fall by twice what it varies by.
  ExtremeCase strict = sphere_case("n = 1.0\n");
  strict.energy_tolerance = -2.0;
  result = run_extreme(strict, "rk4");
  EXPECT_EQ(result.outcome, Outcome::valid);
  EXPECT_FALSE(result.valid);
  EXPECT_NE(result.message.find("energy rose"), std::string::npos) << result.message;
}

TEST(ExtremeRun, SeesBodiesInEachOther) {
  ExtremeCase crowded = sphere_case(
      "n = 1.0\n[simulation]\ncontact = \"impulses\"\n[[body]]\nposition = [1.0, 0.0, 3.5]\nn = "
      "1.0\n");
  crowded.seconds = 0.1;  // too short to part them
  crowded.penetration = 0.1;
  const ExtremeResult result = run_extreme(crowded, "rk4");
  EXPECT_FALSE(result.valid);
  EXPECT_NE(result.message.find("into each other"), std::string::npos) << result.message;
}

TEST(ExtremeRun, JudgesByWhatWasExpected) {
  ExtremeCase extreme = sphere_case("");
  extreme.explicit_outcomes = {Outcome::diverged};
  ExtremeResult result;
  EXPECT_FALSE(as_expected(extreme, false, result)) << "valid, though it should have diverged";
  EXPECT_TRUE(as_expected(extreme, true, result));
  result.valid = false;
  EXPECT_FALSE(as_expected(extreme, true, result));
  result = {};
  result.outcome = Outcome::diverged;
  EXPECT_FALSE(as_expected(extreme, false, result)) << "without a message";
  result.message = "step 3: body a: its volume is -1 m^3";
  EXPECT_TRUE(as_expected(extreme, false, result));
  EXPECT_FALSE(as_expected(extreme, true, result));
}

}  // namespace
}  // namespace pneuma::app
