// What counts as simulated as well as ours, and how it is told from a run.
#include "benchmarks/peer/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "support/worlds.h"

namespace pneuma::benchmarks {
namespace {

/// Calls `move` with the world and the number of the step.
class Scripted : public Simulation {
 public:
  using Move = std::function<void(sim::World&, int)>;
  Scripted(sim::World world, Move move) : world_(std::move(world)), move_(std::move(move)) {}
  void advance(int count) override {
    for (int i = 0; i < count; ++i) move_(world_, ++step_);
  }
  std::size_t contact_count() const override { return 0; }
  const sim::World& state() override { return world_; }

 private:
  sim::World world_;
  Move move_;
  int step_ = 0;
};

sim::World one_cube() {
  return sim::make_free_world(sim::make_body(sim::make_box({2.0, 2.0, 2.0}, 1), {0.0, 0.0, 5.0}));
}

void stretch(sim::World& world, double factor) {
  sim::VertexArray& positions = world.soft[0].positions;
  for (int v = 0; v < positions.size(); ++v) positions[v].x() *= factor;
}

TEST(Quality, InflationMayDifferByATenth) {
  const Quality ours{.inflation = 2.0};
  EXPECT_TRUE(inflates_like({.inflation = 2.19}, ours));
  EXPECT_TRUE(inflates_like({.inflation = 1.81}, ours));
  EXPECT_FALSE(inflates_like({.inflation = 2.21}, ours));
  EXPECT_FALSE(inflates_like({.inflation = 1.79}, ours));
  EXPECT_FALSE(inflates_like({.inflation = std::numeric_limits<double>::infinity()}, ours));
}

TEST(Quality, APeerRestsBelowTheBoundOrWhereOursIsAsFast) {
  EXPECT_TRUE(rests_like({.end_speed = 0.05}, {.end_speed = 0.0}));
  EXPECT_FALSE(rests_like({.end_speed = 0.06}, {.end_speed = 0.0}));
  EXPECT_TRUE(rests_like({.end_speed = 0.06}, {.end_speed = 0.07}));
}

TEST(Quality, APeersBodiesAreApartBelowTheBoundOrWhereOursLieAsDeep) {
  EXPECT_TRUE(keeps_apart_like({.deepest = 0.05}, {.deepest = 0.0}));
  EXPECT_FALSE(keeps_apart_like({.deepest = 0.06}, {.deepest = 0.0}));
  EXPECT_TRUE(keeps_apart_like({.deepest = 0.06}, {.deepest = 0.07}));
}

TEST(Quality, ShortfallIsZeroWhereAllIsReachedAndPutsRestFirst) {
  const Quality ours{.inflation = 2.0};
  EXPECT_EQ(shortfall({.inflation = 1.9, .end_speed = 0.04, .deepest = 0.01}, ours), 0.0);
  const double moves = shortfall({.inflation = 2.0, .end_speed = 0.1}, ours);
  const double is_flat = shortfall({.inflation = 0.1}, ours);
  const double is_deep = shortfall({.inflation = 2.0, .deepest = 1.0}, ours);
  EXPECT_GT(is_flat, 0.0);
  EXPECT_GT(is_deep, is_flat);  // twenty bounds, against nine and a half
  EXPECT_GT(moves, is_deep);
  EXPECT_TRUE(std::isinf(shortfall({.inflation = std::numeric_limits<double>::infinity()}, ours)));
}

TEST(TryOut, InflationIsTheMeanOfTheLastSecond) {
  // Twice as large from the middle of the last second on: of ten looks five see it.
  Scripted run(one_cube(), [](sim::World& world, int step) {
    if (step == 91) stretch(world, 2.0);
  });
  EXPECT_NEAR(try_out(run, 2.0).quality.inflation, 1.5, 1e-12);
}

TEST(TryOut, SpeedIsThatOfTheFastestCentreInTheLastSecond) {
  sim::World world = one_cube();
  world.rigid.emplace_back().position = {50.0, 0.0, 0.0};
  Scripted run(world, [](sim::World& at, int step) {
    at.rigid[0].velocity = {step <= 60 ? 9.0 : 2.0, 0.0, 0.0};
    for (int v = 0; v < 8; ++v)
      at.soft[0].velocities[v] = sim::Vec3(0.0, v % 2 == 0 ? 7.0 : -5.0, 0.0);
  });
  EXPECT_DOUBLE_EQ(try_out(run, 2.0).quality.end_speed, 2.0);  // the soft body's centre: 1
}

TEST(TryOut, FindsHowDeepBodiesLieInEachOtherAndWhatCrosses) {
  sim::World world = one_cube();
  world.rigid.emplace_back().position = {50.0, 0.0, 5.0};
  world.rigid[0].size = {2.0, 2.0, 2.0};
  Scripted run(world, [](sim::World& at, int step) {
    // 0.5 m in the cube's side while the first half lasts, then 0.25 m.
    at.rigid[0].position = {step <= 60 ? 1.5 : 1.75, 0.1, 5.2};
  });
  const Quality quality = try_out(run, 2.0).quality;
  EXPECT_NEAR(quality.deepest, 0.25, 0.0125);  // found to a twentieth
  EXPECT_GT(quality.crossings, 0);
}

TEST(TryOut, EndsWhereABodyIsLost) {
  int steps = 0;
  Scripted run(one_cube(), [&](sim::World& world, int step) {
    steps = step;
    if (step == 30) stretch(world, std::numeric_limits<double>::quiet_NaN());
  });
  EXPECT_TRUE(std::isinf(try_out(run, 2.0).quality.inflation));
  EXPECT_EQ(steps, 30);  // a look every six
}

TEST(SoftVolume, IsTheSumOverTheBodies) {
  sim::World world = sim::make_free_world(sim::make_body(sim::make_box({1.0, 2.0, 3.0}, 1)));
  world.soft.push_back(sim::make_body(sim::make_box({2.0, 2.0, 2.0}, 1)));
  EXPECT_NEAR(soft_volume(world), 14.0, 1e-13);  // rounding
}

}  // namespace
}  // namespace pneuma::benchmarks
