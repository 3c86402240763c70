#include "app/host/timing_conditions.h"

#include <gtest/gtest.h>

namespace pneuma::app {
namespace {

TimingConditions ideal() {
  TimingConditions conditions;
  conditions.load = 0.1;
  conditions.cores = 4;
  conditions.governor = "performance";
  return conditions;
}

/// The one warning there is.
std::string warning(const TimingConditions& conditions) {
  const auto warnings = timing_warnings(conditions);
  EXPECT_EQ(warnings.size(), 1u);
  return warnings.empty() ? "" : warnings[0];
}

TEST(TimingConditions, IdealOnesNeedNoWarning) { EXPECT_TRUE(timing_warnings(ideal()).empty()); }

TEST(TimingConditions, UnknownOnesNeedNoWarning) {
  TimingConditions conditions = ideal();
  conditions.load.reset();
  conditions.governor.reset();
  EXPECT_TRUE(timing_warnings(conditions).empty());
}

TEST(TimingConditions, WarnOfADebugBuild) {
  TimingConditions conditions = ideal();
  conditions.debug_build = true;
  EXPECT_NE(warning(conditions).find("CMAKE_BUILD_TYPE=Release"), std::string::npos);
}

TEST(TimingConditions, WarnOfABusyMachineByLoadPerCore) {
  TimingConditions conditions = ideal();
  conditions.load = 1.9;
  EXPECT_TRUE(timing_warnings(conditions).empty());
  conditions.load = 2.1;
  EXPECT_NE(warning(conditions).find("2.1 processes"), std::string::npos);
}

TEST(TimingConditions, WarnOfAChangingClockSpeed) {
  TimingConditions conditions = ideal();
  conditions.governor = "powersave";
  EXPECT_NE(warning(conditions).find("powersave"), std::string::npos);
}

TEST(TimingConditions, OfThisMachineCanBeAskedFor) { EXPECT_GE(timing_conditions().cores, 1); }

}  // namespace
}  // namespace pneuma::app
