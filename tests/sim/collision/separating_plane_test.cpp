// A plane separates a pair only when no two points of the bodies come within reach: known
// distances, and those of all triangles to each other.
#include "sim/collision/separating_plane.h"

#include <gtest/gtest.h>

#include "sim/collision/surface_view.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// Two spheres with their facing poles `distance` apart along x, the second with a velocity along
/// x.
struct Facing {
  SoftBody first, second;

  Facing(double distance, double speed)
      : first(make_body(make_sphere(1.0, 4, 8))),
        second(make_body(make_sphere(1.0, 4, 8), {2.0 + distance, 0.0, 0.0})) {
    second.velocities.rows().row(0).setConstant(speed);
  }
  bool are_separate(double reach, double seconds) const {
    return has_separating_plane(first, second, {7.0, 0.0, 0.0}, reach, seconds);
  }
};

TEST(SeparatingPlane, SeparatesWhatIsFartherApartThanTheReach) {
  EXPECT_TRUE(Facing(1.01, 0.0).are_separate(1.0, 0.1));
  EXPECT_FALSE(Facing(0.99, 0.0).are_separate(1.0, 0.1));
  EXPECT_FALSE(Facing(-0.5, 0.0).are_separate(0.0, 0.0)) << "they overlap";
}

TEST(SeparatingPlane, LooksAhead) {
  EXPECT_FALSE(Facing(1.5, -6.0).are_separate(1.0, 0.1)) << "0.9 m apart after 0.1 s";
  EXPECT_TRUE(Facing(1.5, -4.0).are_separate(1.0, 0.1)) << "1.1 m";
  EXPECT_FALSE(Facing(0.9, 60.0).are_separate(1.0, 0.1)) << "they part, but are near now";
}

TEST(SeparatingPlane, LooksAheadOfTheFirstBodyToo) {
  Facing bodies(1.5, 0.0);
  bodies.first.velocities.rows().row(0).setConstant(6.0);
  EXPECT_FALSE(bodies.are_separate(1.0, 0.1));
  bodies.first.velocities.rows().row(0).setConstant(4.0);
  EXPECT_TRUE(bodies.are_separate(1.0, 0.1));
}

TEST(SeparatingPlane, WithoutADirectionThereIsNone) {
  const Facing bodies(5.0, 0.0);
  EXPECT_FALSE(has_separating_plane(bodies.first, bodies.second, Vec3::Zero(), 1.0, 0.0));
}

TEST(SeparatingPlane, NeverSeparatesFeaturesWithinReach) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int parted = 0, near = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Facing bodies(0.6 + 0.6 * uniform(random), 0.0);
    perturb(bodies.first, 0.4, static_cast<unsigned>(trial));
    perturb(bodies.second, 0.4, static_cast<unsigned>(trial) + 1000);
    const Vec3 direction(1.0, 0.4 * uniform(random), 0.4 * uniform(random));
    const double reach = 0.3;
    if (!has_separating_plane(bodies.first, bodies.second, direction, reach, 0.0)) {
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
