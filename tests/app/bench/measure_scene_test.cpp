#include "app/bench/measure_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>

#include "app/files/find_scene.h"
#include "app/host/errors.h"
#include "app/world/build_world.h"
#include "app/world/replay.h"
#include "render/context/context.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/inspect.h"

namespace pneuma::app {
namespace {

/// A sphere that touches the ground from the first step on, until its gas throws it up; in tiny
/// pictures.
scenes::Scene small_scene(const std::vector<std::string>& overrides = {}) {
  return scenes::parse_scene(R"(
duration = 1.0
paper_fps = 60.0
[[body]]
kind = "soft"
shape = "sphere"
radius = 1.0
stacks = 4
slices = 4
position = [0.0, 0.0, 1.0]
[picture]
width = 64
height = 48
)",
                             "small.toml", overrides);
}

MeasureOptions few_steps(std::int64_t steps, bool pictures) {
  MeasureOptions options;
  options.steps = steps;
  options.pictures = pictures;
  return options;
}

void expect_sound(const Spread& seconds) {
  EXPECT_GT(seconds.low, 0.0);
  EXPECT_LE(seconds.low, seconds.median);
  EXPECT_LE(seconds.median, seconds.high);
  EXPECT_LT(seconds.high, 60.0);
}

/// Pretends for its life that there is no GL.
class WithoutGl {
 public:
  WithoutGl() { setenv("PNEUMA_GL", "none", 1); }
  ~WithoutGl() { unsetenv("PNEUMA_GL"); }
};

TEST(MeasureScene, MeasuresAsManyStepsAndFramesAsAskedFor) {
  const SceneTimes times = measure_scene(small_scene(), few_steps(7, true));
  EXPECT_EQ(times.name, "small");
  EXPECT_EQ(times.paper_fps, 60.0);
  EXPECT_EQ(times.bodies, 1);
  EXPECT_EQ(times.steps_per_frame, 1);
  if (times.steps_per_reading == 1) {
    EXPECT_EQ(times.steps, 7);
  }
  expect_sound(times.step_seconds);
  ASSERT_TRUE(times.frames);
  EXPECT_EQ(times.frames->frames, 7);
  EXPECT_EQ(times.frames->width, 64);
  EXPECT_EQ(times.frames->height, 48);
  expect_sound(times.frames->seconds);
  EXPECT_GT(times.frames->draw, 0.0);
  EXPECT_GT(times.frames->encode, 0.0);
}

TEST(MeasureScene, MakesParticlesWhereTheyAreShown) {
  MeasureOptions options = few_steps(3, true);
  const scenes::Scene scene =
      scenes::load_scene(find_scene("two_spheres_contact"), std::vector<std::string>{"duration=1"});
  EXPECT_FALSE(measure_scene(scene, options).plan.runs(sim::Stage::move_particles));
  options.show.particles = true;
  const SceneTimes times = measure_scene(scene, options);
  EXPECT_TRUE(times.plan.runs(sim::Stage::move_particles));
  EXPECT_EQ(times.frames->frames, 3);
}

TEST(MeasureScene, MeasuresAfterTheWarmUpToTheEnd) {
  MeasureOptions options = few_steps(1, false);
  options.warm_up = 0.25;
  SceneTimes times = measure_scene(small_scene(), options);
  EXPECT_EQ(times.measured_from, 0.25);
  EXPECT_EQ(times.measured_to, 1.0);
  options.warm_up.reset();
  EXPECT_EQ(measure_scene(small_scene(), options).measured_from, 0.5);
  options.warm_up = 100.0;
  EXPECT_EQ(measure_scene(small_scene(), options).measured_from, 0.5);  // at most half the run
}

TEST(MeasureScene, CountsTheContactsOfTheMeasuredSteps) {
  MeasureOptions options = few_steps(5, false);
  options.warm_up = 0.0;
  const SceneTimes times = measure_scene(small_scene(), options);
  EXPECT_GT(times.contacts.mean(times.contacts.of(sim::ContactKind::soft_ground)), 0.0);
  EXPECT_EQ(times.contacts.touching_share(), 0.0);  // there is no second body
  const SceneTimes flying = measure_scene(small_scene({"body.position=[0, 0, 500]"}), options);
  EXPECT_EQ(flying.contacts.all.sum, 0);
}

TEST(MeasureScene, SharesAddUpAndThoseOfAbsentStagesAreZero) {
  const SceneTimes times = measure_scene(small_scene(), few_steps(50, false));
  EXPECT_NEAR(std::accumulate(times.stage_shares.begin(), times.stage_shares.end(), 0.0), 1.0,
              1e-12);  // six roundings
  for (std::size_t s = 0; s < times.stage_shares.size(); ++s) {
    if (!times.plan.stages[s].runs) {
      EXPECT_EQ(times.stage_shares[s], 0.0) << s;
    }
  }
  EXPECT_FALSE(times.plan.runs(sim::Stage::broad_phase));
}

TEST(MeasureScene, AFrameIsASixtiethOfASecond) {
  EXPECT_EQ(measure_scene(small_scene({"simulation.steps_per_second=240"}), few_steps(1, false))
                .steps_per_frame,
            4);
}

TEST(MeasureScene, WithoutPicturesNeedsNoGl) {
  const WithoutGl missing;
  EXPECT_FALSE(measure_scene(small_scene(), few_steps(3, false)).frames);
  EXPECT_THROW(measure_scene(small_scene(), few_steps(3, true)), render::GlError);
}

TEST(MeasureScene, SaysWhenASceneDiverges) {
  const scenes::Scene scene = small_scene({"body.k=1e12", "simulation.integrator=martin"});
  EXPECT_THROW(measure_scene(scene, few_steps(3, false)), DivergenceError);
}

TEST(MeasureScene, TheClockIsFineEnough) {
  // Linux counts in nanoseconds; a kernel without a usable hardware clock in milliseconds.
  EXPECT_GE(clock_resolution(), 1e-9 * 0.999);
  EXPECT_LT(clock_resolution(), 1e-2);
}

TEST(Replay, GoesThroughTheSameStatesAgainAndAgain) {
  const sim::World start = build_world(small_scene());
  std::vector<std::uint64_t> hashes;
  sim::World world = start;
  sim::Stepper stepper(world);
  for (int i = 0; i < 6; ++i) {
    ASSERT_FALSE(stepper.step(world));
    hashes.push_back(sim::state_hash(world));
  }
  Replay replay("small", start, 6, {});
  for (int pass = 0; pass < 3; ++pass) {
    for (const std::uint64_t hash : hashes) {
      replay.prepare(1);
      replay.run(1);
      EXPECT_EQ(sim::state_hash(replay.world()), hash);
    }
  }
}

TEST(Replay, StartsAgainWhenTooFewStepsAreLeft) {
  Replay replay("small", build_world(small_scene()), 6, {});
  replay.run(4);
  replay.prepare(2);
  EXPECT_EQ(replay.world().steps, 4);
  replay.prepare(3);
  EXPECT_EQ(replay.world().steps, 0);
  replay.prepare(100);  // more than ever fit: from the start on, beyond the end
  replay.run(100);
  EXPECT_EQ(replay.world().steps, 100);
}

}  // namespace
}  // namespace pneuma::app
