// What slides over the edges between triangles that lie in one plane does not feel them.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/mesh/rotation.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

constexpr double speed = 4.0;  // m/s
/// m/s: a point less than 0.03 of its height beside a triangle still counts as over it
/// (contact_places.cpp), which tilts its normal for a step.
constexpr double least_seen = 5e-4;
const Vec3 slab_size(30.0, 6.0, 1.0);

/// All of its vertices are pinned: an obstacle of triangles of about 2.5 by 0.5 m, top at z = 0.
SoftBody make_fine_slab() {
  TriangleMesh mesh = make_box(slab_size, 12);
  for (Vec3& x : mesh.vertices) {  // beside a grid, but for the rims
    x.x() += 0.2 * std::sin(3.0 * x.x() + 7.0 * x.y()) * (1.0 - std::abs(x.x()) / 15.0);
    x.y() += 0.1 * std::sin(9.0 * x.x() + 2.0 * x.y()) * (1.0 - std::abs(x.y()) / 3.0);
  }
  return make_smooth_obstacle(mesh, {0.0, 0.0, -0.5});
}

RigidBox make_slab() {
  RigidBox slab = make_rigid(slab_size, {0.0, 0.0, -0.5});
  slab.is_kinematic = true;
  slab.surface = {0.0, 0.0};
  return slab;
}

class FlatTriangles : public testing::TestWithParam<bool> {
 protected:
  /// Of a static box each side is two triangles.
  static World make_world() {
    World world = make_swept_world();
    world.settings.ground.reset();
    if (GetParam()) {
      world.soft.push_back(make_fine_slab());
    } else {
      world.rigid.push_back(make_slab());
    }
    return world;
  }
};

/// It rings, as it was put down, and none of that may turn into motion along the plane.
TEST_P(FlatTriangles, DoNotBrakeABall) {
  for (const double aside : {-1.07, 0.03, 0.71}) {
    World world = make_world();
    world.settings.steps_per_second = 480;
    world.soft.push_back(make_sliding_ball(2, {-7.03, aside, 1.01}, {speed, 0.0, 0.0}));
    ASSERT_FALSE(run(world, 3.0));
    const Vec3 velocity = mean(world.soft.back().velocities);
    EXPECT_NEAR(velocity.x(), speed, least_seen) << aside;
    EXPECT_NEAR(velocity.y(), 0.0, least_seen) << aside;
  }
}

/// It falls onto a corner and tumbles: impulses of its impacts are some ten times those at rest,
/// and so is what a tilted normal may give.
TEST_P(FlatTriangles, DoNotBrakeABox) {
  for (const double aside : {-1.07, 0.03, 0.71}) {
    World world = make_world();
    world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {-7.03, aside, 0.9}));
    RigidBox& box = world.rigid.back();
    box.orientation = rotation_of_degrees({17.0, -12.0, 31.0});
    box.surface = {0.0, 0.0};
    box.rho_g = 0.0;
    box.velocity.x() = speed;
    ASSERT_FALSE(run(world, 3.0));
    EXPECT_NEAR(world.rigid.back().velocity.x(), speed, 0.01) << aside;
    EXPECT_NEAR(world.rigid.back().velocity.y(), 0.0, 0.01) << aside;
  }
}

INSTANTIATE_TEST_SUITE_P(OfABoxAndFine, FlatTriangles, testing::Bool());

}  // namespace
}  // namespace pneuma::sim
