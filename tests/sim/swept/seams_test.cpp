// What slides past an edge that it does not meet: on from one face onto the next beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/inspect/inspect.h"
#include "sim/mesh/rotation.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

constexpr double speed_after = 0.97;  // of the speed: what a landing from 1 mm may brake

World without_ground(int steps_per_second) {
  World world = make_swept_world();
  world.settings.ground.reset();
  world.settings.gravity = {0.0, 0.0, -9.81};
  world.settings.steps_per_second = steps_per_second;
  return world;
}

/// Two slabs side by side, whose faces join at x = 0, the second lower by `drop` (m); and a box
/// without friction that slides from the first towards it, turned by so many degrees.
World make_seam(int steps_per_second, double drop, double turn, double speed) {
  World world = without_ground(steps_per_second);
  const auto add = [&](const Vec3& size, const Vec3& place) -> RigidBox& {
    world.rigid.push_back(make_rigid(size, place));
    world.rigid.back().surface = {0.1, 0.0};
    world.rigid.back().rho_g = 0.0;
    return world.rigid.back();
  };
  add({4.0, 4.0, 1.0}, {-2.0, 0.0, -0.5}).is_kinematic = true;
  add({4.0, 4.0, 1.0}, {2.0, 0.0, -0.5 - drop}).is_kinematic = true;
  RigidBox& box = add({1.0, 1.0, 0.5}, {-0.9, 0.0, 0.2526});
  box.orientation = rotation_of_degrees({0.0, 0.0, turn});
  box.velocity = {speed, 0.0, 0.0};
  return world;
}

TEST(Seams, DoNotBrakeWhatSlidesOverThem) {
  for (const int steps_per_second : {30, 60, 240}) {
    for (const double drop : {0.0, 0.001}) {
      for (const double turn : {0.0, 10.0}) {
        for (const double speed : {0.1, 0.5, 3.0, 8.0}) {
          World world = make_seam(steps_per_second, drop, turn, speed);
          ASSERT_FALSE(run(world, 0.7 / speed));
          const Vec3& velocity = world.rigid[2].velocity;
          EXPECT_GT(velocity.x(), speed_after * speed)
              << steps_per_second << " " << drop << " " << turn << " " << speed;
          EXPECT_LT(std::abs(velocity.y()), (1.0 - speed_after) * speed) << turn << " " << speed;
        }
      }
    }
  }
}

/// A floor of 10 m along x, of so many static boxes side by side, and a box at `place` above it.
World make_floor(int steps_per_second, int tiles, const Vec3& place, double turn) {
  World world = without_ground(steps_per_second);
  const double width = 10.0 / tiles;
  for (int i = 0; i < tiles; ++i) {
    world.rigid.push_back(make_rigid({width, 4.0, 0.5}, {(i + 0.5) * width, 0.0, -0.25}));
    world.rigid.back().is_kinematic = true;
    world.rigid.back().surface = {0.2, 0.3};
  }
  RigidBox box = make_rigid({0.6, 0.6, 0.4}, place);
  box.orientation = rotation_of_degrees({0.0, 0.0, turn});
  box.surface = {0.0, 0.3};
  box.rho_g = 0.0;
  world.rigid.push_back(box);
  return world;
}

/// Corners that pass a seam within a step are beside the next tile's edge at its end, above it.
TEST(Seams, LetABoxSlideOverTilesAsFarAsFrictionDoes) {
  constexpr double distance = 6.0 * 6.0 / (2.0 * 0.3 * 9.81);
  for (const int steps_per_second : {60, 120, 240, 480}) {
    for (const double turn : {0.0, 10.0, 30.0}) {
      for (double x = 1.33; x < 2.3; x += 0.11) {
        World world = make_floor(steps_per_second, 10, {x, 0.0, 0.2}, turn);
        world.rigid.back().velocity = {6.0, 0.0, 0.0};
        ASSERT_FALSE(run(world, 2.6));
        // Of 1.5 %: what is left of a landing on the next tile by the gap between boxes.
        EXPECT_NEAR(world.rigid.back().position.x() - x, distance, 0.015 * distance)
            << steps_per_second << " " << turn << " " << x;
        EXPECT_LT(std::abs(world.rigid.back().position.y()), 0.015 * distance);
      }
    }
  }
}

/// What would meet the side of a tile within the step is held by the tops of others before.
TEST(Seams, ABoxLandsOnTilesAsOnOne) {
  for (const int steps_per_second : {60, 240}) {
    for (const double turn : {0.0, 10.0, 30.0, 45.0}) {
      for (double x = 1.33; x < 2.3; x += 0.11) {
        const auto lands = [&](int tiles) {
          World world = make_floor(steps_per_second, tiles, {x, 0.0, 0.3}, turn);
          world.rigid.back().velocity = {5.0, 0.0, -2.0};
          EXPECT_FALSE(run(world, 1.0));
          return world.rigid.back();
        };
        const RigidBox one = lands(1), tiles = lands(10);
        // Of 3 m: what is left of a solution, which friction follows.
        EXPECT_LT((tiles.position - one.position).norm(), 0.03)
            << steps_per_second << " " << turn << " " << x;
        EXPECT_LT((tiles.velocity - one.velocity).norm(), 0.03);
      }
    }
  }
}

/// Slabs let into the ground, as a user gives a part of it another friction.
TEST(Seams, ABoxOnTheGroundPassesOverSlabsThatAreLevelWithIt) {
  constexpr double distance = 6.0 * 6.0 / (2.0 * 0.3 * 9.81);
  for (const int steps_per_second : {60, 240, 960}) {
    for (double x = -1.5; x < -0.9; x += 0.11) {
      World world = make_floor(steps_per_second, 10, {x, 0.0, 0.2}, 0.0);
      world.settings.ground = ContactMaterial{0.0, 0.3};
      world.rigid.back().velocity = {6.0, 0.0, 0.0};
      ASSERT_FALSE(run(world, 2.6));
      EXPECT_NEAR(world.rigid.back().position.x() - x, distance, 0.015 * distance)
          << steps_per_second << " " << x;
    }
  }
}

/// Overlaps of a few ten-thousandths of a side bear a box that falls onto them.
TEST(Seams, NarrowLedgesBearABox) {
  for (const int steps_per_second : {30, 60, 240}) {
    for (const double overlap : {0.0003, 0.001, 0.003}) {
      for (const double height : {0.002, 0.1, 0.5}) {
        World world = without_ground(steps_per_second);
        world.rigid = {make_rigid({1.0, 2.0, 1.0}, {-1.0 + overlap, 0.0, -0.5}),
                       make_rigid({1.0, 2.0, 1.0}, {1.0 - overlap, 0.0, -0.5}),
                       make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 0.5 + height})};
        world.rigid[0].is_kinematic = world.rigid[1].is_kinematic = true;
        for (RigidBox& box : world.rigid) box.surface = {0.0, 0.3};
        ASSERT_FALSE(run(world, 1.0));
        EXPECT_NEAR(world.rigid[2].position.z(), 0.5, 0.01)
            << steps_per_second << " " << overlap << " " << height;
      }
    }
  }
}

/// A slab that is higher by more than boxes keep between them does stop it.
TEST(Seams, StopWhatRunsAgainstAStep) {
  for (const int steps_per_second : {30, 60, 240}) {
    World world = make_seam(steps_per_second, -0.3, 0.0, 3.0);
    ASSERT_FALSE(run(world, 0.3));
    EXPECT_LT(world.rigid[2].position.x(), -0.5);
  }
}

/// Without friction, restitution, gravity or drag, above an obstacle whose top is at z = 0.
World make_box_over(const SoftBody& obstacle, double side, const Vec3& place,
                    const Vec3& velocity) {
  World world = without_ground(60);
  world.settings.gravity.setZero();
  world.soft.push_back(obstacle);
  RigidBox box = make_rigid({side, side, side}, place + 0.5 * side * Vec3::UnitZ());
  box.surface = {0.0, 0.0};
  box.rho_g = 0.0;
  box.velocity = velocity;
  world.rigid.push_back(box);
  return world;
}

/// A corner that is beside a triangle when the step begins, and meets it as it comes over it, is
/// held along the normal that it has there.
TEST(Seams, ABoxLandsOnTrianglesAsOnAPlane) {
  // m/s: a corner a little beside a triangle still counts as over it (contact_places.cpp), which
  // tilts its normal for a step.
  constexpr double least_seen = 2e-3;
  const SoftBody floor = make_smooth_obstacle(make_box({6.0, 2.0, 0.5}, 12), {0.0, 0.0, -0.25});
  for (const double falls : {0.35, 0.5, 1.0, 3.0}) {
    for (int i = 0; i < 12; ++i) {
      const Vec3 start(-2.4 - 0.03 * i, 0.1, 0.004 + 0.1 * falls);
      World world = make_box_over(floor, 0.3, start, {20.0, 0.0, -falls});
      ASSERT_FALSE(run(world, 0.2));
      EXPECT_NEAR(world.rigid[0].velocity.x(), 20.0, least_seen) << falls << " " << i;
      EXPECT_NEAR(world.rigid[0].velocity.z(), 0.0, least_seen) << falls << " " << i;
    }
  }
}

/// Of an impact along the normal of what rises before it a box keeps all but its part of the speed.
TEST(Seams, AFoldBrakesABoxByNoMoreThanItRises) {
  for (const double degrees : {0.5, 1.0, 3.0, 8.0}) {
    const double slope = std::tan(degrees * std::numbers::pi / 180.0);
    TriangleMesh mesh = make_box({12.0, 4.0, 0.5}, 2);
    for (Vec3& x : mesh.vertices) x.z() += slope * std::max(0.0, x.x());
    const SoftBody fold = make_smooth_obstacle(mesh, {0.0, 0.0, -0.25});
    for (const double speed : {2.0, 7.0, 20.0}) {
      for (const double side : {0.15, 0.3, 1.2}) {
        World world = make_box_over(fold, side, {-2.0, 0.1, 0.004}, {speed, 0.0, 0.0});
        const double before = energy(world).total();
        ASSERT_FALSE(run(world, 4.0 / speed));
        // Twice that, as one corner after the other may be hit, and what a landing leaves.
        EXPECT_GT(energy(world).total(), (1.0 - 2.0 * slope * slope - 0.005) * before)
            << degrees << " " << speed << " " << side;
      }
    }
  }
}

/// Spheres all equally high, of triangles: a box slides from top to top.
TEST(Seams, ARailOfSpheresDoesNotBrakeABox) {
  World world = without_ground(60);
  for (int i = 0; i < 20; ++i) {
    const Vec3 place(0.9 * (i / 2), i % 2 == 0 ? -0.6 : 0.6, -0.5);
    world.soft.push_back(make_smooth_obstacle(make_icosphere(0.5, 2), place));
  }
  RigidBox box = make_rigid({2.0, 2.0, 0.5}, {1.3, 0.0, 0.26});
  box.surface = {0.0, 0.0};
  box.rho_g = 0.0;
  box.velocity = {3.0, 0.0, 0.0};
  world.rigid.push_back(box);
  ASSERT_FALSE(run(world, 1.5));
  EXPECT_GT(world.rigid[0].velocity.x(), speed_after * 3.0);
}

}  // namespace
}  // namespace pneuma::sim
