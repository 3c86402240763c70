// Impacts of boxes that slide on something (ERRATA row 67).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/mesh/primitives.h"
#include "sim/mesh/rotation.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

constexpr double speed = 3.0, side = 0.5, turn = 35.0;  // m/s, m, degrees

ContactMaterial smooth(double restitution) { return {restitution, 0.0}; }

World smooth_ground(int steps_per_second) {
  World world = make_swept_world();
  world.settings.steps_per_second = steps_per_second;
  world.settings.sleep_speed = 0.0;
  world.settings.ground = smooth(0.0);
  return world;
}

/// A flat box that stands on an edge of its square, 1.5 m from a wall at x = 2, above z = 0.
RigidBox sliding_box(double restitution) {
  RigidBox box = make_rigid({side, side, 0.2}, {0.5, 0.0, 0.1}, 0.2);
  box.orientation = rotation_of_degrees({0.0, 0.0, turn});
  box.velocity = {speed, 0.0, 0.0};
  box.surface = smooth(restitution);
  box.rho_g = 0.0;
  return box;
}

RigidBox wall(double restitution) {
  RigidBox box = make_rigid({0.4, 6.0, 4.0}, {2.2, 0.0, 2.0});
  box.is_kinematic = true;
  box.surface = smooth(restitution);
  return box;
}

/// After a hit without friction at one edge, of what comes at `approach` (m/s) along x.
struct AfterHit {
  double change = 0.0;  // m/s, of the velocity against x
  double spin = 0.0;    // rad/s, against z
};
AfterHit after_hit(double approach, double restitution) {
  const double leading = (45.0 + turn) * std::numbers::pi / 180.0;  // of the edge, from y to x
  const double arm = std::sqrt(0.5) * side * std::cos(leading);
  const double squared_radius = side * side / 6.0;  // of gyration
  const double change = (1.0 + restitution) * approach / (1.0 + arm * arm / squared_radius);
  return {change, change * arm / squared_radius};
}

/// The impulse of the wall must not wait for what the ground does.
void expect_hit(const RigidBox& box, double approach, double restitution) {
  const AfterHit after = after_hit(approach, restitution);
  EXPECT_NEAR(box.velocity.x(), speed - after.change, 1e-3 * speed);
  EXPECT_NEAR(box.angular_velocity.z(), -after.spin, 1e-3 * after.spin);
  EXPECT_LT(box.angular_velocity.head<2>().norm(), 1e-6);
  EXPECT_NEAR(box.velocity.z(), 0.0, 1e-6);
}

TEST(SlidingImpact, OnTheGroundIsThatOfAFreeBox) {
  for (const double restitution : {0.0, 0.2, 1.0}) {
    for (const int steps_per_second : {60, 90, 240, 960}) {
      SCOPED_TRACE(testing::Message() << restitution << " " << steps_per_second);
      World world = smooth_ground(steps_per_second);
      world.rigid = {sliding_box(restitution), wall(restitution)};
      ASSERT_FALSE(run(world, 0.5));
      expect_hit(world.rigid[0], speed, restitution);
    }
  }
}

TEST(SlidingImpact, WithAWallThatIsMovedIsThatAgainstIt) {
  constexpr double restitution = 0.2, wall_speed = 1.0;
  for (const int steps_per_second : {60, 240}) {
    SCOPED_TRACE(steps_per_second);
    World world = smooth_ground(steps_per_second);
    world.rigid = {sliding_box(restitution), wall(restitution)};
    world.rigid[1].velocity = {-wall_speed, 0.0, 0.0};
    const double before = energy(world.rigid[0], world.settings.gravity).total();
    Stepper stepper(world, {.measure_work = true, .plan = {}});
    double work = 0.0, driven = 0.0;
    while (time(world) < 0.35) {
      ASSERT_FALSE(stepper.step(world));
      work += stepper.contact_work();
      driven += stepper.driven_work();
    }
    expect_hit(world.rigid[0], speed + wall_speed, restitution);
    const double after = energy(world.rigid[0], world.settings.gravity).total();
    EXPECT_NEAR(after - before, work + driven, 1e-9);
    const double impulse = -0.2 * after_hit(speed + wall_speed, restitution).change;
    EXPECT_NEAR(driven, impulse * -wall_speed, 1e-3 * std::abs(impulse));
  }
}

/// A slab that carries the box along: what it bears is seen against it.
TEST(SlidingImpact, OnABeltIsThatOfAFreeBox) {
  constexpr double restitution = 0.2;
  for (const int steps_per_second : {60, 240}) {
    SCOPED_TRACE(steps_per_second);
    World world = smooth_ground(steps_per_second);
    world.settings.ground.reset();
    RigidBox belt = make_rigid({20.0, 6.0, 0.5}, {0.0, 0.0, -0.25});
    belt.is_kinematic = true;
    belt.surface = smooth(0.0);
    belt.velocity = {1.0, 0.5, 0.0};
    RigidBox post = wall(restitution);
    post.position.z() += 0.02;
    world.rigid = {sliding_box(restitution), post, belt};
    world.rigid[0].position.z() += 0.0025 * (0.2 + 0.5);  // boxes keep their skins apart
    ASSERT_FALSE(run(world, 0.5));
    const AfterHit after = after_hit(speed, restitution);
    EXPECT_NEAR(world.rigid[0].velocity.x(), speed - after.change, 0.01 * speed);
    EXPECT_NEAR(world.rigid[0].angular_velocity.z(), -after.spin, 0.01 * after.spin);
  }
}

/// Boxes that slide and turn in a frame hit it and each other, hundreds of times.
TEST(SlidingImpact, OfElasticBoxesInAFrameKeepsTheirEnergy) {
  for (const int steps_per_second : {60, 240}) {
    World world = smooth_ground(steps_per_second);
    for (const double sign : {-1.0, 1.0}) {
      for (const bool along_x : {true, false}) {
        RigidBox rail = along_x ? make_rigid({10.0, 0.4, 0.6}, {0.0, sign * 3.0, 0.3})
                                : make_rigid({0.4, 6.0, 0.6}, {sign * 5.0, 0.0, 0.3});
        rail.is_kinematic = true;
        rail.surface = smooth(1.0);
        world.rigid.push_back(rail);
      }
    }
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int i = 0; i < 5; ++i) {
      RigidBox puck = sliding_box(1.0);
      puck.position.head<2>() = 1.5 * Eigen::Vector2d(i - 2, any(random));
      puck.velocity.head<2>() = 3.0 * Eigen::Vector2d(any(random), any(random));
      world.rigid.push_back(puck);
    }
    const double before = energy(world).kinetic;
    ASSERT_FALSE(run(world, 20.0));
    // What hits of two others within one step cost.
    EXPECT_NEAR(energy(world).kinetic, before, 0.01 * before) << steps_per_second;
  }
}

/// A wall that leans away sends the box up: from then on the floor bears nothing of it.
TEST(SlidingImpact, ThatLiftsABoxAddsNoEnergy) {
  for (int i = 0; i < 10; ++i) {  // hit sooner or later in a step, in which it goes by 0.1 m
    World world = smooth_ground(30);
    RigidBox leaning = wall(1.0);
    leaning.orientation = rotation_of_degrees({0.0, -8.0, 0.0});
    world.rigid = {sliding_box(1.0), leaning};
    world.rigid[0].size.z() = 0.3;
    world.rigid[0].position = {-0.01 * i, 0.0, 0.15};
    world.rigid[0].orientation.setIdentity();
    Stepper stepper(world);
    double last = energy(world).total(), rise = 0.0, highest = 0.0;
    while (time(world) < 1.2) {
      ASSERT_FALSE(stepper.step(world));
      const double now = energy(world).total();
      rise = std::max(rise, now - last);
      last = now;
      highest = std::max(highest, world.rigid[0].position.z());
    }
    EXPECT_GT(highest, 0.17);
    // Of 0.9 J: without weight until the step ends it would gain up to m (g h)^2 / 2, 0.0107 J.
    EXPECT_LT(rise, 5e-4) << i;
  }
}

/// A plank that tips over the edge of what it slides on is no box that lies on a floor.
TEST(SlidingImpact, OfAPlankThatTipsLetsItTip) {
  for (const int steps_per_second : {60, 240, 960}) {
    World world = smooth_ground(steps_per_second);
    world.settings.ground.reset();
    RigidBox beam = make_rigid({6.0, 0.1, 0.4}, {0.0, 0.0, -0.2});
    beam.is_kinematic = true;
    beam.surface = smooth(0.0);
    RigidBox plank = make_rigid({0.3, 1.6, 0.1}, {1.2, 0.06, 0.0511});
    plank.velocity = {speed, 0.0, 0.0};
    plank.surface = smooth(0.9);
    plank.rho_g = 0.0;
    world.rigid = {plank, wall(0.9), beam};
    Stepper stepper(world);
    double tipping = 0.0;
    while (world.rigid[0].velocity.x() > 0.0) {
      tipping = world.rigid[0].angular_velocity.x();
      ASSERT_FALSE(stepper.step(world));
      ASSERT_LT(time(world), 1.0);
    }
    EXPECT_LT(tipping, -0.05);
    EXPECT_LT(world.rigid[0].angular_velocity.x(), tipping) << steps_per_second;
  }
}

/// The hit comes as a step ends, at the distance that they keep: rounding chooses which corners are
/// nearer, and the others must not wait for the next step.
TEST(SlidingImpact, OfFacesAtTheEndOfAStepDoesNotTurnThem) {
  World world = smooth_ground(240);
  for (const double x : {-1.2, 0.0, 0.525}) {
    RigidBox box = make_rigid(Vec3::Constant(0.5), {x, 0.0, 0.25});
    box.surface = smooth(1.0);
    box.rho_g = 0.0;
    world.rigid.push_back(box);
  }
  world.rigid[0].velocity = {4.8, 0.0, 0.0};
  ASSERT_FALSE(run(world, 0.5));
  EXPECT_NEAR(world.rigid[2].velocity.x(), 4.8, 1e-6);
  for (const RigidBox& box : world.rigid) EXPECT_LT(box.angular_velocity.norm(), 1e-6);
}

/// Of two boxes on the ground, which bears both.
TEST(SlidingImpact, OfTwoBoxesKeepsMomentumAlongTheGround) {
  for (const int steps_per_second : {60, 240}) {
    World world = smooth_ground(steps_per_second);
    RigidBox other = make_rigid({1.0, 0.4, 0.2}, {2.0, 0.2, 0.1}, 0.7);
    other.orientation = rotation_of_degrees({0.0, 0.0, 70.0});
    other.surface = {0.5, 0.4};
    other.rho_g = 0.0;
    world.rigid = {sliding_box(0.5), other};
    world.rigid[0].surface.friction = 0.4;
    const Momentum before = momentum(world);
    ASSERT_FALSE(run(world, 1.0));
    const Momentum after = momentum(world);
    EXPECT_GT(world.rigid[1].velocity.x(), 0.1);
    // What is left of a solution where they stay near each other.
    EXPECT_LT((after.linear - before.linear).head<2>().norm(), 1e-6 * before.linear.norm());
    EXPECT_NEAR(after.angular.z(), before.angular.z(), 1e-6 * before.linear.norm());
  }
}

/// What a box carries, or a wall of triangles, keeps its hit from being that of a lone pair: it is
/// stopped by impulses at both ends of the step. Turned away from the wall by the first, it must
/// not get back at the second what has stopped it, and hang there for steps.
TEST(Impact, DoesNotHoldABoxThatTurnsAwayFromIt) {
  const auto hangs = [](World& world) {
    Stepper stepper(world);
    int steps = 0;
    while (time(world) < 0.8) {
      const Vec3 place = world.rigid[0].position;
      EXPECT_FALSE(stepper.step(world));
      const Vec3 way = (world.rigid[0].position - place) / time_step(world.settings);
      steps += (way - world.rigid[0].velocity).norm() > 0.2 * speed ? 1 : 0;
    }
    return steps;
  };
  for (const double angle : {10.0, 20.0, 35.0, 60.0, 80.0}) {
    World carries = smooth_ground(60);
    carries.rigid = {sliding_box(0.2), wall(0.2), sliding_box(0.2)};
    carries.rigid[2].size = Vec3::Constant(0.1);
    carries.rigid[2].position.z() = 0.25;
    World meets_triangles = smooth_ground(60);
    meets_triangles.rigid = {sliding_box(0.2)};
    meets_triangles.soft.push_back(
        make_smooth_obstacle(make_box({0.4, 6.0, 4.0}, 1), {2.2, 0.0, 2.0}));
    meets_triangles.soft[0].material.surface = smooth(0.2);
    for (World* world : {&carries, &meets_triangles}) {
      world->rigid[0].orientation = rotation_of_degrees({0.0, 0.0, angle});
      EXPECT_LE(hangs(*world), 2) << angle;
    }
  }
}

/// At the end of a step, or near it as the step begins, as on a wall that is a box.
TEST(Impact, OnTrianglesBouncesAtShortStepsToo) {
  for (const int steps_per_second : {480, 960, 1920}) {
    for (const double away : {0.0, 0.001, 0.002, 0.003, 0.004}) {
      World world = smooth_ground(steps_per_second);
      world.settings.gravity = Vec3::Zero();
      world.settings.ground.reset();
      world.rigid = {sliding_box(1.0)};
      world.rigid[0].position.x() -= away;
      world.soft.push_back(make_smooth_obstacle(make_box({0.4, 6.0, 4.0}, 1), {2.2, 0.0, 2.07}));
      world.soft[0].material.surface = smooth(1.0);
      ASSERT_FALSE(run(world, 0.5));
      const AfterHit after = after_hit(speed, 1.0);
      EXPECT_NEAR(world.rigid[0].velocity.x(), speed - after.change, 0.05 * speed)
          << steps_per_second << " " << away;
    }
  }
}

}  // namespace
}  // namespace pneuma::sim
