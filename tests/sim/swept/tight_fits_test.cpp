// A box in a gap that leaves less room than it keeps from each of the walls (ERRATA row 67).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

const Vec3 wall_size(2.0, 3.0, 2.0);  // m
const Vec3 box_size(0.5, 0.6, 0.7);   // m; it would keep 2.5 mm from each wall
constexpr double start_height = 2.9;  // m, of its middle: it starts above the walls

RigidBox make_wall(const Vec3& position) {
  RigidBox wall = make_rigid(wall_size, position);
  wall.is_kinematic = true;
  return wall;
}

struct Fit {
  double room = 0.0;    // m, of both sides together
  double aside = 0.0;   // of the room: by so much the box is off the middle
  bool is_box = false;  // the walls are boxes, not of triangles
};

class TightFits : public testing::TestWithParam<Fit> {
 protected:
  static World make_shaft(int steps_per_second, double friction) {
    const auto [room, aside, is_box] = GetParam();
    World world = make_swept_world();
    world.settings.steps_per_second = steps_per_second;
    world.settings.ground = ContactMaterial{0.0, friction};
    RigidBox box = make_rigid(box_size, {aside * room, 0.0, start_height});
    box.rho_g = 0.0;
    for (const double side : {-1.0, 1.0}) {
      const Vec3 place(side * 0.5 * (wall_size.x() + box_size.x() + room), 0.0, 1.0);
      if (is_box) {
        world.rigid.push_back(make_wall(place));
        world.rigid.back().surface = {0.0, friction};
      } else {
        world.soft.push_back(make_smooth_obstacle(make_box(wall_size, 1), place));
        world.soft.back().material.surface = {0.0, friction};
      }
    }
    box.surface = {0.0, friction};
    world.rigid.push_back(box);
    return world;
  }

  /// Runs for 1.2 s. The greatest rise of the energy in a step, J, of 20.
  static double greatest_rise(World& world) {
    Stepper stepper(world);
    double last = energy(world).total(), rise = 0.0;
    while (time(world) < 1.2) {
      const auto divergence = stepper.step(world);
      EXPECT_FALSE(divergence) << divergence->what;
      if (divergence) break;
      const double now = energy(world).total();
      rise = std::max(rise, now - last);
      last = now;
      EXPECT_EQ(crossings(world).between_bodies, 0) << time(world);
    }
    return rise;
  }
};

void expect_free_fall(World& world) {
  Stepper stepper(world);
  const RigidBox& box = world.rigid.back();
  const double gained = world.settings.gravity.z() * time_step(world.settings);
  const double above_ground = 0.5 * box_size.z() + 0.2;
  while (time(world) < 1.0) {
    const double before = box.velocity.z();
    const auto divergence = stepper.step(world);
    ASSERT_FALSE(divergence) << divergence->what;
    if (box.position.z() < above_ground) return;
    ASSERT_NEAR(box.velocity.z() - before, gained, 1e-3) << time(world);
  }
  ADD_FAILURE() << "it is still at " << box.position.z() << " m";
}

/// Nothing holds it: it had been thrown back by impulses that grew between the walls.
TEST_P(TightFits, LetABoxFallFreely) {
  for (const int steps_per_second : {60, 240}) {
    for (const double friction : {0.0, 0.4}) {
      World world = make_shaft(steps_per_second, friction);
      expect_free_fall(world);
      EXPECT_LT(greatest_rise(world), 1e-3);
      EXPECT_NEAR(world.rigid.back().position.z(), 0.5 * box_size.z(), 0.005);
    }
  }
}

TEST_P(TightFits, AddNoEnergyWithFriction) {
  for (const int steps_per_second : {60, 240, 960}) {
    World world = make_shaft(steps_per_second, 0.4);
    EXPECT_LT(greatest_rise(world), 1e-3) << steps_per_second;
    EXPECT_NEAR(world.rigid.back().position.z(), 0.5 * box_size.z(), 0.005) << steps_per_second;
  }
}

/// Two cubes side by side in a slot that fits them: friction without a force along the normal would
/// hold them up, against each other and the walls.
TEST(RowInASlot, FallsToItsBottom) {
  for (const double room : {0.0, 5e-4, 4e-3}) {
    for (const double friction : {0.1, 0.5}) {
      World world = make_swept_world();
      world.settings.ground = ContactMaterial{0.0, friction};
      for (const double side : {-1.0, 1.0}) {
        world.rigid.push_back(make_wall({side * (1.0 + 0.5 * (wall_size.x() + room)), 0.0, 1.1}));
        world.rigid.push_back(make_rigid(Vec3::Ones(), {0.5 * side, 0.0, 1.5}));
      }
      for (RigidBox& box : world.rigid) {
        box.surface = {0.0, friction};
        box.rho_g = 0.0;
      }
      ASSERT_FALSE(run(world, 0.4));
      for (const int i : {1, 3}) {
        EXPECT_NEAR(world.rigid[at(i)].velocity.z(), -9.81 * 0.4, 1e-3) << room << ' ' << friction;
      }
      ASSERT_FALSE(run(world, 1.0));
      for (const int i : {1, 3}) {
        EXPECT_NEAR(world.rigid[at(i)].position.z(), 0.5, 1e-4) << room << ' ' << friction;
      }
    }
  }
}

/// A box that slides on the ground under a ceiling that touches it presses only the ground.
TEST(BoxUnderACeiling, SlidesAsWithoutIt) {
  for (const double room : {0.0, 5e-4, 3e-3}) {
    World world = make_swept_world();
    world.settings.ground = ContactMaterial{0.0, 0.5};
    world.rigid.push_back(make_rigid({8.0, 2.0, 1.0}, {0.0, 0.0, 1.5 + room}));
    world.rigid.back().is_kinematic = true;
    world.rigid.push_back(make_rigid(Vec3::Ones(), {-2.0, 0.0, 0.5}));
    world.rigid.back().velocity.x() = 2.0;
    for (RigidBox& box : world.rigid) {
      box.surface = {0.0, 0.5};
      box.rho_g = 0.0;
    }
    ASSERT_FALSE(run(world, 1.0));
    // The step in which it comes to rest is unknown to mu g h^2 / 2, 0.7 mm.
    EXPECT_NEAR(world.rigid[1].position.x() + 2.0, 2.0 * 2.0 / (2.0 * 0.5 * 9.81), 1e-3) << room;
    EXPECT_NEAR(world.rigid[1].position.z(), 0.5, 1e-4) << room;
  }
}

constexpr double plate_height = 0.2;  // m
constexpr double clearance = 1e-3;    // m, on each of the four sides

/// A cube of 1 m in a shaft of four walls, above a plate that is moved.
World make_piston(int steps_per_second) {
  World world = make_swept_world();
  world.settings.steps_per_second = steps_per_second;
  const ContactMaterial rough{0.0, 0.3};
  for (const int axis : {0, 1}) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 size(3.0, 3.0, 4.0), place(0.0, 0.0, 2.5);
      size[axis] = 1.0;
      place[axis] = side * (1.0 + clearance);
      world.rigid.push_back(make_rigid(size, place));
      world.rigid.back().is_kinematic = true;
    }
  }
  world.rigid.push_back(make_rigid({0.8, 0.8, plate_height}, {0.0, 0.0, 0.1}));
  world.rigid.back().is_kinematic = true;
  world.rigid.push_back(make_rigid(Vec3::Ones(), {0.0, 0.0, 0.71}));
  for (RigidBox& box : world.rigid) box.surface = rough;
  return world;
}

/// It presses neither wall, and so friction holds it nowhere.
TEST(Piston, FollowsItsPlateUpAndDown) {
  for (const int steps_per_second : {60, 240}) {
    World world = make_piston(steps_per_second);
    RigidBox& plate = world.rigid[4];
    for (const double speed : {0.0, 1.0, 0.0, -1.0, 0.0}) {
      plate.velocity.z() = speed;
      ASSERT_FALSE(run(world, 1.0));
    }
    const double height = world.rigid.back().position.z() - plate.position.z();
    EXPECT_NEAR(height, 0.5 * (1.0 + plate_height), 0.005) << steps_per_second;
  }
}

TEST(Piston, LandsOnTheBottomOfItsShaft) {
  for (const int steps_per_second : {60, 240}) {
    World world = make_piston(steps_per_second);
    world.rigid.erase(world.rigid.begin() + 4);
    world.rigid.back().position.z() = 4.0;
    ASSERT_FALSE(run(world, 1.5));
    EXPECT_NEAR(world.rigid.back().position.z(), 0.5, 0.001) << steps_per_second;
  }
}

/// The distance that boxes keep is 2.5 mm here: whether it is there must not depend on the place of
/// the box, or what lies on one wall falls and is lifted again for ever.
TEST(TightFit, HoldsABoxOnASlopeUnderACeiling) {
  constexpr double angle = 0.26;  // rad; friction holds up to 0.54
  for (const double room : {1e-3, 2.75e-3, 3e-3, 3.5e-3, 4e-3}) {
    for (const int steps_per_second : {60, 240, 960}) {
      World world = make_swept_world();
      world.settings.ground.reset();
      world.settings.steps_per_second = steps_per_second;
      world.settings.gravity = 9.81 * Vec3(-std::sin(angle), 0.0, -std::cos(angle));
      for (const double middle : {-0.25, box_size.z() + room + 0.25}) {
        world.rigid.push_back(make_rigid({20.0, 20.0, 0.5}, {0.0, 0.0, middle}));
        world.rigid.back().is_kinematic = true;
      }
      world.rigid.push_back(make_rigid(box_size, {0.0, 0.0, 0.5 * box_size.z() + 0.4 * room}));
      for (RigidBox& box : world.rigid) box.surface = {0.0, 0.6};
      ASSERT_FALSE(run(world, 1.0));
      const Vec3 start = world.rigid.back().position;
      ASSERT_FALSE(run(world, 3.0));
      EXPECT_LT((world.rigid.back().position - start).norm(), 1e-5) << room;
      EXPECT_LT(world.rigid.back().velocity.norm(), 1e-5) << room;
    }
  }
}

/// Half a millimetre between all of them: shifts find no room, and do not push them into walls.
TEST(TightFit, BoxesSideBySideInABinDoNotCross) {
  constexpr double side = 0.5, room = 5e-4;
  constexpr int count = 8;
  const double width = count * side + (count + 1) * room;
  World world = make_swept_world();
  for (const double towards : {-1.0, 1.0}) {
    const double place = towards * 0.5 * (width + side);
    world.rigid.push_back(make_rigid({side, width + 1.0, 3.0}, {place, 0.0, 1.5}));
    world.rigid.push_back(make_rigid({width, side, 3.0}, {0.0, place, 1.5}));
  }
  for (RigidBox& box : world.rigid) box.is_kinematic = true;
  for (int i = 0; i < count * count; ++i) {
    const auto place = [&](int k) { return -0.5 * width + room + (side + room) * k + 0.5 * side; };
    world.rigid.push_back(
        make_rigid(Vec3::Constant(side), {place(i / count), place(i % count), 0.3}));
  }
  const auto divergence = run(world, 1.0);
  ASSERT_FALSE(divergence) << divergence->what;
  EXPECT_LT(max_penetration(world), 1e-4);
  for (std::size_t i = 4; i < world.rigid.size(); ++i) {
    EXPECT_NEAR(world.rigid[i].position.z(), 0.5 * side, 0.005);
  }
}

INSTANTIATE_TEST_SUITE_P(Walls, TightFits,
                         testing::Values(Fit{0.0005, 0.1, true}, Fit{0.001, 0.2, true},
                                         Fit{0.001, -0.1, true}, Fit{0.002, 0.1, true},
                                         Fit{0.001, 0.1, false}, Fit{0.002, -0.2, false}));

}  // namespace
}  // namespace pneuma::sim
