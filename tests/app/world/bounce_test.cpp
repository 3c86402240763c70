// What falls on a ball comes back up: contacts take no more of the motion than they have given.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/world/build_world.h"
#include "app/world/replay.h"
#include "scenes/loader/load_scene.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

const std::string lower_ball =
    "[[body]]\nshape = \"icosphere\"\nsubdivisions = 2\nradius = 2\nstiffness = 500\n"
    "vertex_mass = 0.01\ninflation = 1.2\nposition = [0, 0, 2.1]\n[[body]]\n";

/// m, by which the upper body's centre comes up between 0.97 s, when it is lowest, and 1.8 s.
double rise_after_bounce(const std::string& upper, int steps_per_second) {
  const std::string simulation =
      fmt::format("[simulation]\nsteps_per_second = {}\n", steps_per_second);
  sim::World world = build_world(scenes::parse_scene(simulation + lower_ball + upper, "bounce"));
  sim::Stepper stepper(world);
  advance(stepper, world, static_cast<std::int64_t>(0.97 * steps_per_second), "bounce");
  const auto height = [&] {
    return world.rigid.empty() ? sim::mean(world.soft[1].positions).z()
                               : world.rigid[0].position.z();
  };
  const double lowest = height();
  double highest = lowest;
  for (int i = 0; i < 0.83 * steps_per_second; ++i) {
    advance(stepper, world, 1, "bounce");
    highest = std::max(highest, height());
  }
  return highest - lowest;
}

// What contacts take is of first order in the step: of some 1 m to which bodies come back, a tenth.
TEST(Bounce, ABoxComesBackFromABallOfItsMass) {
  const std::string box =
      "kind = \"rigid\"\nsize = [1.5, 1.5, 1.5]\nmass = 16.2\nposition = [0, 0, 5.2]\n";
  const double rise = rise_after_bounce(box, 1920);
  EXPECT_GT(rise, 1.0);
  EXPECT_NEAR(rise_after_bounce(box, 240), rise, 0.1);
}

TEST(Bounce, AStiffBallComesBackFromASoftOne) {
  const std::string ball =
      "shape = \"icosphere\"\nradius = 1\nstiffness = 5000\nvertex_mass = 0.1\ninflation = 1.05\n"
      "position = [0, 0, 5.4]\n";
  const double rise = rise_after_bounce(ball, 1920);
  EXPECT_GT(rise, 1.0);
  EXPECT_NEAR(rise_after_bounce(ball, 390), rise, 0.2);
}

}  // namespace
}  // namespace pneuma::app
