// A pair is left out only when no two points of the bodies come within reach: known distances, and
// those of all triangles to each other.
#include "sim/collision/approach.h"

#include <gtest/gtest.h>

#include "sim/collision/surface_view.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// Two spheres with their facing poles `gap` apart along x, the second with a velocity along x.
struct Facing {
  SoftBody first, second;

  Facing(double gap, double speed)
      : first(make_body(make_sphere(1.0, 4, 8))),
        second(make_body(make_sphere(1.0, 4, 8), {2.0 + gap, 0.0, 0.0})) {
    second.velocities.rows().row(0).setConstant(speed);
  }
  bool may_touch(double reach, double seconds) const {
    return sim::may_touch(first, second, {7.0, 0.0, 0.0}, reach, seconds);
  }
};

TEST(Approach, LeavesOutWhatIsFartherApartThanTheReach) {
  EXPECT_FALSE(Facing(1.01, 0.0).may_touch(1.0, 0.1));
  EXPECT_TRUE(Facing(0.99, 0.0).may_touch(1.0, 0.1));
  EXPECT_TRUE(Facing(-0.5, 0.0).may_touch(0.0, 0.0)) << "they overlap";
}

TEST(Approach, LooksAhead) {
  EXPECT_TRUE(Facing(1.5, -6.0).may_touch(1.0, 0.1)) << "0.9 m apart after 0.1 s";
  EXPECT_FALSE(Facing(1.5, -4.0).may_touch(1.0, 0.1)) << "1.1 m";
  EXPECT_TRUE(Facing(0.9, 60.0).may_touch(1.0, 0.1)) << "they part, but are near now";
}

TEST(Approach, LooksAheadOfTheFirstBodyToo) {
  Facing bodies(1.5, 0.0);
  bodies.first.velocities.rows().row(0).setConstant(6.0);
  EXPECT_TRUE(bodies.may_touch(1.0, 0.1));
  bodies.first.velocities.rows().row(0).setConstant(4.0);
  EXPECT_FALSE(bodies.may_touch(1.0, 0.1));
}

TEST(Approach, WithoutADirectionTheyMayTouch) {
  const Facing bodies(5.0, 0.0);
  EXPECT_TRUE(may_touch(bodies.first, bodies.second, Vec3::Zero(), 1.0, 0.0));
}

TEST(Approach, NeverLeavesOutFeaturesWithinReach) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int parted = 0, near = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Facing bodies(0.6 + 0.6 * uniform(random), 0.0);
    perturb(bodies.first, 0.4, static_cast<unsigned>(trial));
    perturb(bodies.second, 0.4, static_cast<unsigned>(trial) + 1000);
    const Vec3 direction(1.0, 0.4 * uniform(random), 0.4 * uniform(random));
    const double reach = 0.3;
    if (may_touch(bodies.first, bodies.second, direction, reach, 0.0)) {
      ++near;
      continue;
    }
    ++parted;
    const SurfaceView first{bodies.first.mesh->topology, bodies.first.positions};
    const SurfaceView second{bodies.second.mesh->topology, bodies.second.positions};
    for (int s = 0; s < first.topology.triangle_count(); ++s) {
      for (int t = 0; t < second.topology.triangle_count(); ++t) {
        ASSERT_FALSE(
            test_triangle_triangle(triangle_corners(first, s), triangle_corners(second, t), reach));
      }
    }
  }
  EXPECT_GT(parted, 30);
  EXPECT_GT(near, 30);
}

}  // namespace
}  // namespace pneuma::sim
