#include "app/study/solvers/solver_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace pneuma::app {
namespace {

TEST(SolverCases, AreTheSameBodyOnFinerMeshesWithBothMotions) {
  std::set<int> sizes;
  const std::vector<SolverCase> cases = solver_cases(false);
  ASSERT_EQ(cases.size(), 10u);
  for (const SolverCase& one : cases) {
    const Flight flight = prepare_flight(one.scene, one.options.flight);
    const sim::SoftBody& body = flight.world.soft.front();
    sizes.insert(body.positions.size());
    EXPECT_EQ(one.vertices, body.positions.size());
    EXPECT_FALSE(flight.contacts);
    EXPECT_NEAR(body.material.vertex_mass * body.positions.size(), 20.3, 1e-9);
    EXPECT_EQ(body.material.k, 50.0);
  }
  EXPECT_EQ(sizes, (std::set{58, 162, 642, 2562, 10242}));
}

TEST(SolverCases, OursMayChooseStepsAsFinelyAsTheirTolerances) {
  const ErrorOptions options = solver_cases(false).front().options;
  ASSERT_TRUE(std::ranges::is_sorted(options.steps_per_second));
  for (std::size_t i = 1; i < options.steps_per_second.size(); ++i) {
    EXPECT_EQ(options.steps_per_second[i] % samples_per_second, 0);
    if (i > 2) {
      EXPECT_LE(options.steps_per_second[i], 1.34 * options.steps_per_second[i - 1]);
    }
  }
}

}  // namespace
}  // namespace pneuma::app
