// Boxes much heavier than the soft bodies that they fall on, with swept contacts (ERRATA rows 59
// and 67).
#include <gtest/gtest.h>

#include <algorithm>

#include "sim/inspect/inspect.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

/// What stops a box on a ball that it has pressed flat is no load that the next step has to bear
/// again: started from it, iterations left so much of it that the box was thrown higher than it had
/// fallen from.
TEST(HeavyBoxes, AreNotThrownByTheImpulsesThatStoppedThem) {
  for (const auto& [mass, height] :
       {std::pair(3e4, 8.5), std::pair(3e4, 9.0), std::pair(5e4, 9.0), std::pair(1.2e5, 9.0)}) {
    World world = make_swept_world();
    world.settings.integrator = Integrator::sdirk2;
    world.soft.push_back(make_ball({0.0, 0.0, 3.5}));  // 20 kg
    world.soft[0].material.n = 1.0;
    world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {0.0, 0.0, height}, mass));
    const double fall = energy(world).total() - mass * 9.81 * 1.0;
    double lowest = energy(world).total(), rise = 0.0;
    Stepper stepper(world);
    while (time(world) < 3.0) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << mass << " " << height << ": " << divergence->what;
      const double now = energy(world).total();
      rise = std::max(rise, now - lowest);
      lowest = std::min(lowest, now);
    }
    // What is moved apart lifts a box on a sheet of gas by millimetres.
    EXPECT_LT(rise, 0.02 * fall) << mass << " " << height;
    EXPECT_NEAR(world.rigid[0].position.z(), 1.0, 0.1) << mass << " " << height;
  }
}

}  // namespace
}  // namespace pneuma::sim
