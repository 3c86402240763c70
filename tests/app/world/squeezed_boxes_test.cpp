// Boxes between what nothing moves: there is no motion that keeps all apart, and none must come of
// the attempt.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/inspect.h"
#include "sim/step/stepper.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

/// What a run of boxes comes to that something moved squeezes.
struct Squeezed {
  double fastest = 0.0;  // m/s, of a free box, from 3.2 s on
  double work = 0.0;     // J, of what is moved
  bool has_failed = false;
};

/// Three boxes of 10 kg in a row before a wall, towards which something moves by `way` m in 3 s:
/// by 3.5 m they fit exactly.
Squeezed squeeze(double way, int steps_per_second) {
  const std::string text = fmt::format(R"(duration = 4
[simulation]
steps_per_second = {}
[[body]]
kind = "static"
size = [0.5, 4, 2]
position = [5, 0, 1]
[[body]]
kind = "moved"
size = [0.5, 4, 1.9]
position = [-5, 0, 1]
motion.path = [[0, 0, 0, 0], [3, {}, 0, 0], [4, {}, 0, 0]]
[[body]]
kind = "rigid"
size = [2, 2, 2]
mass = 10
position = [-2.5, 0, 1]
copies = [3, 1, 1]
spacing = [2.3, 0, 0]
)",
                                       steps_per_second, way, way);
  sim::World world = build_world(scenes::parse_scene(text, "squeeze.toml"));
  sim::Stepper stepper(world);
  Squeezed run;
  while (sim::time(world) < 4.0 && !run.has_failed) {
    run.has_failed = stepper.step(world).has_value();
    run.work += stepper.driven_work();
    if (sim::time(world) < 3.2) continue;
    for (const sim::RigidBox& box : world.rigid) {
      if (!box.is_kinematic) run.fastest = std::max(run.fastest, box.velocity.norm());
    }
  }
  return run;
}

/// They weigh 294 N and are pushed by 2.0 to 2.75 m, with a friction of one half: 350 J, and what
/// they lose as they are hit. Where the room ends nothing that is moved does any more work.
TEST(SqueezedBoxes, StayWhereTheyAre) {
  for (const int steps : {60, 240}) {
    for (const double way : {3.40, 3.49, 3.50, 3.51}) {
      const Squeezed run = squeeze(way, steps);
      EXPECT_FALSE(run.has_failed) << way << " m, " << steps << " steps/s";
      EXPECT_LT(run.fastest, 0.05) << way << " m, " << steps << " steps/s";
      EXPECT_NEAR(run.work, 650.0, 350.0) << way << " m, " << steps << " steps/s";
    }
    EXPECT_TRUE(squeeze(3.65, steps).has_failed);
  }
}

/// A plate presses the short arm of a plank on a fulcrum, whose long arm carries a load: by
/// (long / short)^2 times what would give the load the plate's speed.
TEST(SqueezedBoxes, ALeverIsNotSqueezed) {
  for (const double length : {3.0, 5.0}) {
    const std::string text =
        fmt::format(R"(duration = 1
[simulation]
steps_per_second = 240
[[body]]
kind = "static"
size = [0.2, 2, 1]
position = [0, 0, 0.6]
[[body]]
kind = "rigid"
size = [{}, 1, 0.3]
mass = 50
position = [{}, 0, 1.2525]
[[body]]
kind = "static"
size = [0.4, 2, 1]
position = [{}, 0, 0.6]
[[body]]
name = "load"
kind = "rigid"
size = [1, 1, 1]
mass = 100
position = [{}, 0, 1.905]
[[body]]
kind = "moved"
size = [0.3, 1, 0.5]
position = [-1, 0, 1.7]
motion.path = [[0, 0, 0, 0], [0.2, 0, 0, -0.03], [1, 0, 0, -0.2]]
)",
                    length + 1.3, 0.5 * (length - 1.3), length - 0.6, length - 0.5);
    sim::World world = build_world(scenes::parse_scene(text, "lever.toml"));
    const auto divergence = sim::run(world, 1.0);
    ASSERT_FALSE(divergence) << divergence->what;
    const auto load = std::ranges::find(world.rigid, std::string("load"), &sim::RigidBox::name);
    EXPECT_GT(load->position.z(), 1.905 + 0.1 * length);
  }
}

/// Boxes that touch are moved apart by a few millimetres. A ball that lies on them leaves no room
/// for it.
TEST(SqueezedBoxes, BelowABallGoNowhere) {
  for (const double k : {50.0, 100.0}) {
    const std::string text = fmt::format(R"(duration = 1
[[body]]
name = "box"
kind = "rigid"
size = [2, 2, 1]
mass = 3
position = [0, 0, 0.5]
copies = [1, 1, 3]
spacing = [0, 0, 1]
[[body]]
name = "ball"
radius = 1.5
k = {}
inflation = 1.2
mass = 2
position = [0, 0, 4.7]
)",
                                         k);
    sim::World world = build_world(scenes::parse_scene(text, "ball_on_boxes.toml"));
    const std::vector<sim::RigidBox> start = world.rigid;
    const auto divergence = sim::run(world, 1.0);
    ASSERT_FALSE(divergence) << divergence->what;
    for (std::size_t i = 0; i < start.size(); ++i) {
      const double distance = (world.rigid[i].position - start[i].position).norm();
      EXPECT_LT(distance, 0.006) << world.rigid[i].name << ", k = " << k;
    }
  }
}

/// What a box keeps from walls gives it play, and no more as it sinks between walls that come
/// together: these are 1 m apart at a height of 2 m.
TEST(SqueezedBoxes, InAFunnelComeToRest) {
  std::string text = "duration = 6\n[simulation]\nsteps_per_second = 240\n";
  for (const double side : {-1.0, 1.0}) {
    text += fmt::format(
        "[[body]]\nkind = \"static\"\nsize = [0.4, 3, 5]\nposition = [{}, 0, 1.982569]\n"
        "rotation = [0, {}, 0]\nfriction = 0.1\n",
        side * 0.699239, side * 5.0);
  }
  text += "[[body]]\nkind = \"rigid\"\nsize = [1, 1, 1]\nposition = [0, 0, 2.52]\nfriction = 0.1\n";
  sim::World world = build_world(scenes::parse_scene(text, "funnel.toml"));
  ASSERT_FALSE(sim::run(world, 2.0));
  const double height = world.rigid.back().position.z();
  EXPECT_NEAR(height, 2.5, 0.01);
  ASSERT_FALSE(sim::run(world, 4.0));
  EXPECT_NEAR(world.rigid.back().position.z(), height, 1e-4);
  EXPECT_LT(sim::max_penetration(world), 1e-4);  // a twentieth of the distance that they keep
}

}  // namespace
}  // namespace pneuma::app
