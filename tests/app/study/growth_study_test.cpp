#include "app/study/growth/growth_study.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pneuma::app {
namespace {

TEST(GrowthStudy, FitsTheTimesItMeasured) {
  const std::vector<GrowthSeries> all =
      study_growth({.few = true, .seconds_per_point = 0.01}, [](const std::string&) {});
  ASSERT_EQ(all.size(), 5U);
  for (const GrowthSeries& series : all) {
    ASSERT_EQ(series.points.size(), 2U) << series.name;
    const auto& [first, second] = std::pair(series.points[0], series.points[1]);
    EXPECT_GT(first.step_seconds, 0.0);
    EXPECT_LT(first.size, second.size);
    // Two points determine the powers; 1e-12 is rounding in their logarithms.
    const double longer = std::log(second.step_seconds / first.step_seconds);
    const double more = std::log(1.0 * second.steps_per_second / first.steps_per_second);
    const double larger = std::log(second.size / first.size);
    EXPECT_NEAR(series.step.exponent, longer / larger, 1e-12) << series.name;
    EXPECT_NEAR(series.second.exponent, (longer + more) / larger, 1e-12) << series.name;
  }
  EXPECT_EQ(all[0].points[0].size, 162.0);
  EXPECT_EQ(all[1].points[0].size, 84.0);
  EXPECT_EQ(all[2].points[0].size, 84.0);
  EXPECT_EQ(all[3].points[1].size, 9.0);
  EXPECT_EQ(all[4].points[1].size, 45.0);
  for (const int of_vertices : {0, 1}) {
    const std::vector<GrowthPoint>& points = all[static_cast<std::size_t>(of_vertices)].points;
    EXPECT_EQ(points[1].steps_per_second, 2 * points[0].steps_per_second);
  }
}

TEST(GrowthStudy, TheDiagramNamesTheExponents) {
  const GrowthSeries series{.name = "things",
                            .points = {{1.0, 1e-6, 60}, {10.0, 2e-5, 120}},
                            .step = {},
                            .second = {.exponent = 1.6, .factor = 6e-5}};
  const Diagram diagram = growth_diagram({series});
  ASSERT_EQ(diagram.series.size(), 1U);
  EXPECT_EQ(diagram.series[0].name, "things: exponent 1.60");
  EXPECT_DOUBLE_EQ(diagram.series[0].points[1].y, 240.0);  // 120 steps of 20 us for 10
}

}  // namespace
}  // namespace pneuma::app
