// What bodies do on others that nothing moves, beside closed forms and shorter steps: what slides
// is not braked, what is out of balance moves.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/step/stepper.h"
#include "tests/assets/model_writers.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

constexpr double gravity_on_slope = 9.81;  // m/s^2
const double slope = 15.0 * std::numbers::pi / 180.0;

sim::World world_of(const TemporaryFolder& folder, const std::string& scene) {
  write_text(folder / "scene.toml", scene);
  return build_world(scenes::load_scene(folder / "scene.toml"));
}

void run_for(sim::World& world, double seconds) {
  sim::Stepper stepper(world);
  const int steps = static_cast<int>(seconds * world.settings.steps_per_second + 0.5);
  for (int i = 0; i < steps; ++i) {
    const auto divergence = stepper.step(world);
    ASSERT_FALSE(divergence) << divergence->what;
  }
}

/// A ball without friction or drag above a slope of 15 degrees, downwards along x.
std::string ball_on_slope(const std::string& ramp, int steps_per_second) {
  return fmt::format(R"(duration = 3
[simulation]
steps_per_second = {}
[ground]
present = false
[[body]]
name = "ramp"
kind = "static"
{}
rotation = [0, 15, 0]
friction = 1
[[body]]
name = "ball"
shape = "icosphere"
radius = 1
subdivisions = 2
n = 0.15
rest = "equilibrium"
k = 200
mass = 1
position = [-10, 0, 4.27]
friction = 0
restitution = 0
rho_g = 0
)",
                     steps_per_second, ramp);
}

double along_slope(const Vec3& v) { return v.x() * std::cos(slope) - v.z() * std::sin(slope); }
double above_slope(const Vec3& x) { return x.x() * std::sin(slope) + x.z() * std::cos(slope); }

TEST(HeldMotion, WhatHasNoFrictionSlidesAsItFalls) {
  const TemporaryFolder folder;
  for (const int steps_per_second : {180, 240}) {
    sim::World world = world_of(folder, ball_on_slope("size = [60, 20, 1]", steps_per_second));
    run_for(world, 2.0);
    // Motion pays for work of contacts that makes energy grow: 1e-4 of it here.
    const double expected = 2.0 * gravity_on_slope * std::sin(slope);
    EXPECT_NEAR(along_slope(sim::mean(world.soft[0].velocities)), expected, 5e-4 * expected)
        << steps_per_second;
  }
}

/// Of twelve triangles 60 m long, or of as many as a box: the ball lies on both alike.
TEST(HeldMotion, LargeTrianglesKeepNoDistance) {
  const TemporaryFolder folder;
  sim::TriangleMesh slab = sim::make_box({60.0, 20.0, 1.0}, 1);
  write_text(folder / "slab.obj", assets::obj_text(slab));
  sim::World on_box = world_of(folder, ball_on_slope("size = [60, 20, 1]", 240));
  sim::World on_slab =
      world_of(folder, ball_on_slope("shape = \"model\"\nmodel.file = \"slab.obj\"", 240));
  ASSERT_EQ(on_slab.soft.size(), 2u);
  run_for(on_box, 2.0);
  run_for(on_slab, 2.0);
  // Both skins together are 6 mm.
  EXPECT_NEAR(above_slope(sim::mean(on_slab.soft[1].positions)),
              above_slope(sim::mean(on_box.soft[0].positions)), 0.006);
}

/// A plate that swings on a balloon: where it is after 4 s, m.
double height_of_plate(const TemporaryFolder& folder, int steps_per_second) {
  sim::World world = world_of(folder, fmt::format(R"(duration = 5
[simulation]
steps_per_second = {}
[[body]]
name = "balloon"
shape = "icosphere"
radius = 1.5
subdivisions = 3
position = [0, 0, 1.72]
rest = "equilibrium"
n = 0.5
k = 200
mass = 0.6
rho_g = 0.03
[[body]]
name = "lower"
kind = "static"
size = [4, 4, 0.2]
position = [0, 0, 0.1]
[[body]]
name = "upper"
kind = "rigid"
size = [4, 4, 0.2]
mass = 50
position = [0, 0, 3.6]
rho_g = 0.03
)",
                                                  steps_per_second));
  run_for(world, 4.0);
  return world.rigid[1].position.z();
}

TEST(HeldMotion, APlateOnABalloonSwingsAlikeInShorterSteps) {
  const TemporaryFolder folder;
  const double coarse = height_of_plate(folder, 480), fine = height_of_plate(folder, 960);
  // Of a swing by 0.36 m. Stopped at the turning points of 2 or 3 s it would be 0.1 m off.
  EXPECT_NEAR(coarse, fine, 0.015);
  EXPECT_NEAR(fine, 1.755, 0.01);  // at 1,920 steps/s
}

/// A ball that bounces between plates that nothing moves, without weight, air or drag.
constexpr const char* ball_between_plates = R"(duration = 4
[simulation]
steps_per_second = 180
gravity = [0, 0, 0]
[ground]
present = false
[[body]]
kind = "static"
size = [14, 14, 1]
rotation = [0, -1.2, 0]
friction = 0
restitution = 0
[[body]]
kind = "static"
position = [0, 0, 4.23]
size = [14, 14, 1]
rotation = [0, 1.2, 0]
friction = 1
restitution = 0.5
[[body]]
shape = "icosphere"
radius = 1
subdivisions = 2
rest = "equilibrium"
position = [-2.6, 0, 2.115]
velocity = [-0.12, -0.08, -1.41]
k = 150
n = 0.3
mass = 1
rho_g = 0
restitution = 0
)";

TEST(HeldMotion, ContactsGiveBackNoMoreThanTheyTook) {
  sim::World world = build_world(scenes::parse_scene(ball_between_plates, "plates"));
  const sim::Energy start = sim::energy(world);
  // Of the energy that its motion has at first, what may come back of earlier losses
  // (sim/step/swept/excess_work.h), at a step near the longest that the ball bears.
  const double most = 0.05 * start.kinetic, rounding = 1e-12 * std::abs(start.total());
  double least = start.total(), rise = 0.0;
  sim::Stepper stepper(world);
  for (int i = 0; i < 4 * 180; ++i) {
    ASSERT_FALSE(stepper.step(world));
    const double now = sim::energy(world).total();
    EXPECT_LE(now, start.total() + rounding) << i;
    rise = std::max(rise, now - least);
    least = std::min(least, now);
  }
  EXPECT_LT(rise, most);
  EXPECT_LT(least, start.total() - 0.1 * start.kinetic) << "it hit nothing";
}

}  // namespace
}  // namespace pneuma::app
