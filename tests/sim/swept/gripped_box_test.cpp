// A box, or a row of boxes, between moved boxes that leave it less room than it fills (ERRATA
// row 67).
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "sim/inspect/inspect.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

constexpr double jaw_width = 0.2;  // m
constexpr double open = 0.1;       // m, on each side of the cube of 1 m

/// Jaws beside cubes on the ground that touch.
World make_gripper(int steps_per_second, double friction, int cubes = 1) {
  World world = make_swept_world();
  world.settings.steps_per_second = steps_per_second;
  world.settings.ground = ContactMaterial{0.0, friction};
  for (const double side : {-1.0, 1.0}) {
    const Vec3 place(side * (0.5 * (cubes + jaw_width) + open), 0.0, 0.5);
    world.rigid.push_back(make_rigid({jaw_width, 1.0, 0.6}, place));
    world.rigid.back().is_kinematic = true;
  }
  for (int i = 0; i < cubes; ++i) {
    world.rigid.push_back(make_rigid(Vec3::Ones(), {i - 0.5 * (cubes - 1), 0.0, 0.5}));
  }
  for (RigidBox& box : world.rigid) {
    box.surface = {0.0, friction};
    box.rho_g = 0.0;
  }
  return world;
}

/// Jaws that have moved stay such as may press, also while they stand.
class Gripper {
 public:
  explicit Gripper(World world) : world_(std::move(world)), stepper_(world_) {}

  /// From the left.
  const RigidBox& cube(int i = 0) const { return world_.rigid[at(2 + i)]; }
  /// m/s, of the first cube so far.
  double fastest() const { return fastest_; }

  void move_jaws(double together, const Vec3& velocity, double seconds) {
    move_each(velocity + together * Vec3::UnitX(), velocity - together * Vec3::UnitX(), seconds);
  }
  void move_each(const Vec3& left, const Vec3& right, double seconds) {
    world_.rigid[0].velocity = left;
    world_.rigid[1].velocity = right;
    const int steps = static_cast<int>(seconds * world_.settings.steps_per_second + 0.5);
    for (int i = 0; i < steps; ++i) {
      ASSERT_FALSE(stepper_.step(world_));
      fastest_ = std::max(fastest_, cube().velocity.norm());
    }
  }

  /// `overlap`: m, of each jaw.
  void grip(double overlap) {
    move_jaws(open + overlap, Vec3::Zero(), 1.0);
    move_jaws(0.0, Vec3::Zero(), 0.25);
  }

 private:
  World world_;
  Stepper stepper_;
  double fastest_ = 0.0;
};

TEST(GrippedBox, GoesWithTheJaws) {
  for (const int steps_per_second : {60, 240}) {
    for (const double overlap : {0.0, 5e-3}) {
      Gripper gripper(make_gripper(steps_per_second, 0.3));
      gripper.grip(overlap);
      const Vec3 start = gripper.cube().position;
      gripper.move_jaws(0.0, {0.0, 0.0, 0.5}, 2.0);
      gripper.move_jaws(0.0, {0.0, 1.0, 0.0}, 1.0);
      gripper.move_jaws(0.0, {1.0, 0.0, 0.0}, 0.5);
      gripper.move_jaws(0.0, Vec3::Zero(), 1.0);
      const Vec3 way = gripper.cube().position - start;
      // The free motion of the step in which the jaws turn off, and what friction then takes back.
      EXPECT_LT((way - Vec3(0.5, 1.0, 1.0)).norm(), 0.01) << steps_per_second << ' ' << overlap;
      EXPECT_LT(gripper.cube().velocity.norm(), 1e-3) << steps_per_second << ' ' << overlap;
    }
  }
}

TEST(GrippedBox, FallsOnceItIsReleased) {
  Gripper gripper(make_gripper(240, 0.3));
  gripper.grip(1e-3);
  gripper.move_jaws(0.0, {0.0, 0.0, 1.0}, 2.0);
  gripper.move_jaws(-0.5, Vec3::Zero(), 0.3);
  EXPECT_NEAR(gripper.cube().velocity.z(), -9.81 * 0.3,
              9.81 * 2.0 / 240.0);  // its first steps
}

/// Held by both, it would tilt into them.
TEST(GrippedBox, IsNotHeldByAPlateThatSlidesAndTheGround) {
  for (const int steps_per_second : {60, 240}) {
    for (const double overlap : {0.0, 1e-3}) {
      World world = make_gripper(steps_per_second, 0.5);
      world.rigid.erase(world.rigid.begin());
      world.rigid[0] = make_rigid({12.0, 12.0, 1.0}, {0.0, 0.0, 1.5 + 0.1});
      world.rigid[0].is_kinematic = true;
      world.rigid[0].surface = {0.0, 0.5};
      world.rigid[0].velocity = {0.0, 0.0, -0.1 - overlap};
      ASSERT_FALSE(run(world, 1.0));
      world.rigid[0].velocity = {0.1, 0.0, 0.0};
      ASSERT_FALSE(run(world, 3.0)) << steps_per_second << ' ' << overlap;
      EXPECT_LT(world.rigid.back().velocity.norm(), 0.11) << steps_per_second << ' ' << overlap;
      EXPECT_LT(max_penetration(world), overlap + 1e-3) << steps_per_second << ' ' << overlap;
    }
  }
}

TEST(GrippedBox, SlipsWithoutFriction) {
  Gripper gripper(make_gripper(60, 0.0));
  gripper.grip(1e-3);
  gripper.move_jaws(0.0, {0.0, 0.0, 0.5}, 1.0);
  EXPECT_NEAR(gripper.cube().position.z(), 0.5, 1e-3);
}

/// As does a box that only lies between them.
TEST(GrippedBox, IsNotHeldByJawsThatLeaveItRoom) {
  Gripper gripper(make_gripper(60, 0.8));
  gripper.grip(-1e-3);
  gripper.move_jaws(0.0, {0.0, 0.0, 0.5}, 1.0);
  EXPECT_NEAR(gripper.cube().position.z(), 0.5, 1e-3);
}

/// It lies 2 mm deep in both together: what one of them opens is shared by both gaps.
TEST(GrippedBox, IsHeldByAJawThatCreeps) {
  Gripper gripper(make_gripper(60, 0.5));
  gripper.grip(1e-3);
  gripper.move_jaws(0.0, {0.0, 0.0, 1.0}, 1.0);
  const Vec3 start = gripper.cube().position;
  gripper.move_each(Vec3::Zero(), {5e-4, 0.0, 0.0}, 2.0);
  EXPECT_LT((gripper.cube().position - start - Vec3(5e-4, 0.0, 0.0)).norm(), 1e-4);
}

/// The jaws slide along it as it is stopped: the forces of both sides, hundreds of times its
/// weight, leave nothing of each other.
TEST(GrippedBox, IsNotThrownByWhatItIsDrivenInto) {
  for (const int steps_per_second : {60, 240}) {
    World world = make_gripper(steps_per_second, 0.8);
    for (RigidBox& box : world.rigid) box.position.z() += 1.0;
    RigidBox slab = make_rigid({4.0, 3.0, 1.0}, {0.0, 0.0, 0.5});
    slab.is_kinematic = true;
    slab.surface = {0.0, 0.5};
    world.rigid.push_back(slab);
    Gripper gripper(std::move(world));
    gripper.grip(3e-3);
    gripper.move_jaws(0.0, {0.0, 0.0, 0.3}, 1.0);
    gripper.move_jaws(0.0, {0.0, 0.0, -0.3}, 1.02);
    gripper.move_jaws(0.0, Vec3::Zero(), 0.5);
    EXPECT_LT(gripper.fastest(), 0.5) << steps_per_second;
    EXPECT_NEAR(gripper.cube().position.z(), 1.5, 5e-3) << steps_per_second;
  }
}

/// Of which only the outer ones touch a jaw.
TEST(GrippedRow, GoesWithTheJaws) {
  for (const int cubes : {2, 5}) {
    for (const double overlap : {0.0, 5e-3}) {
      Gripper gripper(make_gripper(60, 0.5, cubes));
      gripper.grip(overlap);
      const Vec3 lift(0.0, 0.0, 1.5);
      gripper.move_jaws(0.0, lift, 2.0);
      for (int i = 0; i < cubes; ++i) {
        const RigidBox& held = gripper.cube(i);
        // Half of the distance that they keep: by so much a row may tilt as the jaws close.
        EXPECT_NEAR(held.position.z(), 3.5, 1e-3) << cubes << ' ' << overlap << ' ' << i;
        EXPECT_LT((held.velocity - lift).norm(), 1e-4) << cubes << ' ' << overlap << ' ' << i;
      }
    }
  }
}

TEST(GrippedRow, FallsOnceItIsReleased) {
  Gripper gripper(make_gripper(60, 0.5, 3));
  gripper.grip(2e-3);
  gripper.move_jaws(0.0, {0.0, 0.0, 1.0}, 1.0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(gripper.cube(i).position.z(), 1.5, 5e-3) << i;
  gripper.move_jaws(-0.1, Vec3::Zero(), 1.0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(gripper.cube(i).position.z(), 0.5, 5e-3) << i;
}

/// It sags as it is released, and touches with corners: so long a row is none that is squeezed.
TEST(GrippedRow, FallsWhenTheJawsPartSlowly) {
  Gripper gripper(make_gripper(240, 0.5, 3));
  gripper.grip(2e-3);
  gripper.move_jaws(0.0, {0.0, 0.0, 1.0}, 1.0);
  gripper.move_jaws(-5e-3, Vec3::Zero(), 4.0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(gripper.cube(i).position.z(), 0.5, 5e-3) << i;
}

TEST(GrippedRow, SlipsWithoutFriction) {
  Gripper gripper(make_gripper(60, 0.0, 3));
  gripper.grip(2e-3);
  gripper.move_jaws(0.0, {0.0, 0.0, 0.5}, 1.0);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(gripper.cube(i).position.z(), 0.5, 5e-3) << i;
}

/// Whether jaws lift cubes that bear a box of `width` m and `load` times the mass of one.
bool lift(int cubes, double width, double load) {
  World world = make_gripper(240, 0.5, cubes);
  RigidBox heavy = make_rigid({width, 0.5, 0.5}, {0.0, 0.0, 1.25});
  heavy.mass = load * world.rigid.back().mass;
  world.rigid.push_back(heavy);
  Gripper gripper(std::move(world));
  gripper.grip(1e-3);
  gripper.move_jaws(0.0, {0.0, 0.0, 0.5}, 1.0);
  return gripper.cube().position.z() > 0.95;
}

/// A load on it of fifty times its mass, and not of two hundred times.
TEST(GrippedBox, HoldsEightyTimesItsWeight) {
  EXPECT_TRUE(lift(1, 0.5, 50.0));
  EXPECT_FALSE(lift(1, 0.5, 200.0));
}

/// The jaws press as hard as the mass of all asks for.
TEST(GrippedRow, HoldsEightyTimesTheWeightOfAll) {
  EXPECT_TRUE(lift(3, 2.5, 100.0));
  EXPECT_FALSE(lift(3, 2.5, 600.0));
}

}  // namespace
}  // namespace pneuma::sim
