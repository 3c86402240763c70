// Boxes in substeps (sim/boxes/box_islands.h): what they keep, and that they stand.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "sim/boxes/substep_solver.h"
#include "sim/inspect/overlap.h"
#include "sim/mesh/rotation.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 vector(double size) {
    const double x = number(-size, size), y = number(-size, size), z = number(-size, size);
    return {x, y, z};
  }

 private:
  std::mt19937 random_;
};

World make_ground_world() {
  World world;
  world.settings.ground = ContactMaterial{0.1, 0.5};
  world.settings.sleep_speed = 0.0;  // they must stand by themselves
  return world;
}

RigidBox make_cube(const Vec3& position) {
  RigidBox cube = make_rigid({2.0, 2.0, 2.0}, position);
  cube.rho_g = 0.0;
  cube.surface = {0.1, 0.5};
  return cube;
}

double fastest(const World& world) {
  double speed = 0.0;
  for (const RigidBox& box : world.rigid) speed = std::max(speed, box.velocity.norm());
  return speed;
}

double deepest(const World& world) {
  double depth = 0.0;
  for (const Overlap& overlap : overlaps(world)) depth = std::max(depth, overlap.depth);
  return depth;
}

/// Two boxes that meet with a turn, in free space, as the solver has them.
TEST(Substeps, OneContactIsSolvedAndKeepsMomentum) {
  RigidBox one = make_rigid({2.0, 1.0, 3.0}, {0.1, 0.2, 2.004}, 2.0);
  RigidBox other = make_rigid({2.0, 2.0, 1.0}, {0.0, 0.0, 0.0}, 3.0);
  one.velocity = {0.3, -0.2, -1.0};
  one.angular_velocity = {0.1, 0.2, 0.3};
  one.rho_g = other.rho_g = 0.0;
  World world;
  world.settings.gravity.setZero();
  world.settings.ground.reset();
  world.rigid = {one, other};
  const Momentum before = momentum(world);
  SubstepSolver solver;
  for (RigidBox& box : world.rigid) solver.add(box, motion_of(box), 0.001);
  solver.begin_part();
  const auto found = find_box_manifold(0.1, solver.shape(0), solver.shape(1));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->count, 4);
  solver.contacts().emplace_back(0, 1, solver.box(0), solver.box(1), *found, 0.004,
                                 ContactMaterial{0.0, 0.4}, 1.0);
  solver.run(4, 0.001, Vec3::Zero());
  solver.end_part();
  EXPECT_LT((momentum(world).linear - before.linear).norm(), 1e-14);
  EXPECT_LT((momentum(world).angular - before.angular).norm(), 1e-13);
  // They no longer approach each other at any of the points.
  for (const BoxContactPoint& point : found->points()) {
    const auto velocity = [&](const RigidBox& box) -> Vec3 {
      return box.velocity + box.angular_velocity.cross(point.point - box.position);
    };
    const double along = found->normal.dot(velocity(world.rigid[0]) - velocity(world.rigid[1]));
    EXPECT_GT(along, -0.02);
  }
  EXPECT_LT(energy(world).kinetic, 0.5 * 2.0 * 1.13 + 1.0);
}

/// Of the impulses that a contact remembers, a new one makes the same.
TEST(Substeps, ImpulsesAreTheSameFromTheirPoints) {
  SubstepSolver solver;
  RigidBox one = make_rigid({2.0, 2.0, 2.0}, {0.3, 0.1, 2.0}),
           other = make_rigid({3, 3, 2}, {0, 0, 0});
  one.angular_velocity = {0.0, 0.0, 2.0};
  one.velocity = {1.0, 0.0, -1.0};
  solver.add(one, motion_of(one), 0.01);
  solver.add(other, motion_of(other), 0.01);
  solver.begin_part();
  const auto found = find_box_manifold(0.1, solver.shape(0), solver.shape(1));
  ASSERT_TRUE(found);
  const auto make = [&] {
    return SubstepContact(0, 1, solver.box(0), solver.box(1), *found, 0.0, {0.0, 0.5}, 1.0);
  };
  SubstepContact contact = make(), again = make();
  SubstepBox a = solver.box(0), b = solver.box(1);
  contact.push(a, b, {}, 0.01);
  contact.relax(a, b, 0.01);
  contact.relax(a, b, 0.01);
  ASSERT_TRUE(contact.presses());
  again.start_from(contact.impulses());
  for (std::size_t i = 0; i < contact.count(); ++i) {
    EXPECT_LT((contact.impulses()[i] - again.impulses()[i]).norm(), 1e-12) << i;
  }
}

/// Boxes of any shape that fly into each other.
World make_free_pile(unsigned seed) {
  Dice dice(seed);
  World world;
  world.settings.gravity.setZero();
  world.settings.ground.reset();
  const int count = 2 + static_cast<int>(seed % 7);
  for (int i = 0; i < count; ++i) {
    const Vec3 side = Vec3::Constant(1.5) + dice.vector(0.5);
    const Vec3 place(3.0 * (i % 2), 3.0 * (i / 2 % 2), 3.0 * (i / 4));
    RigidBox box =
        make_rigid(i % 2 == 0 ? Vec3::Constant(side.x()) : side, place, dice.number(1, 3));
    box.orientation = rotation_of_degrees(dice.vector(180.0));
    box.velocity = Vec3(1.5, 1.5, 1.5) - place + dice.vector(0.3);
    box.angular_velocity = dice.vector(1.0);
    box.rho_g = 0.0;
    box.surface = {0.1, 0.5};
    world.rigid.push_back(box);
  }
  return world;
}

TEST(Substeps, FreePilesKeepMomentumAndGainNothing) {
  std::size_t contacts = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    World world = make_free_pile(seed);
    const Momentum before = momentum(world);
    const double start = energy(world).kinetic;
    double scale = 0.0;  // of the parts, which cancel
    for (const RigidBox& box : world.rigid) {
      scale += box.mass * box.velocity.norm() * (1.0 + box.position.norm());
    }
    Stepper stepper(world, {.measure_work = true, .plan = {}});
    for (int i = 0; i < 120; ++i) {
      const double last = energy(world).kinetic;
      ASSERT_FALSE(stepper.step(world));
      contacts += stepper.contacts().size();
      ASSERT_LE(energy(world).kinetic, last + 1e-3 * start) << seed << ' ' << i;
    }
    EXPECT_LE(energy(world).kinetic, start);
    EXPECT_LT((momentum(world).linear - before.linear).norm(), 1e-12 * scale) << seed;
    EXPECT_LT((momentum(world).angular - before.angular).norm(), 1e-10 * scale) << seed;
  }
  EXPECT_GT(contacts, 500u);
}

/// 2 to 50 boxes that fall onto the ground and each other.
World make_random_pile(unsigned seed) {
  Dice dice(seed);
  World world = make_ground_world();
  const int count = 2 + static_cast<int>(seed * 7 % 49);
  for (int i = 0; i < count; ++i) {
    const Vec3 place(2.6 * (i % 3), 2.6 * (i / 3 % 3), 2.0 + 2.6 * (i / 9));
    const Vec3 side = Vec3::Constant(1.0) + dice.vector(0.4);
    world.rigid.push_back(make_rigid(side, place, dice.number(0.5, 2.0)));
    world.rigid.back().orientation = rotation_of_degrees(dice.vector(180.0));
  }
  return world;
}

/// Beyond free flight, whose steps give a box m (g h)^2 / 2 and take it away again at rest.
void expect_no_gain(unsigned seed) {
  World world = make_random_pile(seed);
  double mass = 0.0;
  for (const RigidBox& box : world.rigid) mass += box.mass;
  const double of_gravity = 0.5 * mass * std::pow(9.81 / 60.0, 2);
  Stepper stepper(world, {.measure_work = true, .plan = {}});
  for (int i = 0; i < 180; ++i) {
    const double before = energy(world).total();
    ASSERT_FALSE(stepper.step(world)) << seed;
    ASSERT_LE(energy(world).total(), before + of_gravity) << seed << ", step " << i;
  }
}

TEST(Substeps, RandomPilesNeverGainEnergy) {
  for (unsigned seed = 0; seed < 20; ++seed) expect_no_gain(seed);
}

TEST(ManyPiles, NeverGainEnergy) {
  for (unsigned seed = 100; seed < 10100; ++seed) expect_no_gain(seed);
}

TEST(Substeps, FortyStacksTurnedAtRandomStand) {
  Dice dice(11);
  World world = make_ground_world();
  constexpr int stacks = 40, high = 10;
  for (int stack = 0; stack < stacks; ++stack) {
    for (int i = 0; i < high; ++i) {
      world.rigid.push_back(make_cube({10.0 * (stack % 8), 10.0 * (stack / 8), 1.0 + 2.0 * i}));
      world.rigid.back().orientation = rotation_of_degrees({0.0, 0.0, dice.number(0.0, 90.0)});
    }
  }
  const World start = world;
  ASSERT_FALSE(run(world, 10.0));
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    const Vec3 way = world.rigid[i].position - start.rigid[i].position;
    EXPECT_LT(way.norm(), 0.01 * 2.0 * high) << "cube " << i % high << " of " << i / high;
  }
  EXPECT_LT(fastest(world), 0.01);
}

TEST(Substeps, APyramidOfTwentyRowsStands) {
  World world = make_ground_world();
  constexpr int rows = 20;
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      world.rigid.push_back(make_cube({2.1 * i + 1.05 * row, 0.0, 1.0 + 2.0 * row}));
    }
  }
  const Vec3 start = world.rigid.back().position;
  ASSERT_FALSE(run(world, 10.0));
  EXPECT_LT((world.rigid.back().position - start).head<2>().norm(), 0.01 * 2.0 * rows);
  EXPECT_LT(fastest(world), 0.01);
  EXPECT_LT(deepest(world), 0.01);
}

TEST(Substeps, ATowerOfTwentyStandsForAMinute) {
  World world = make_ground_world();
  for (int i = 0; i < 20; ++i) world.rigid.push_back(make_cube({0.0, 0.0, 1.0 + 2.0 * i}));
  ASSERT_FALSE(run(world, 60.0));
  EXPECT_LT(world.rigid.back().position.head<2>().norm(), 0.01 * 40.0);
  EXPECT_LT(fastest(world), 0.01);
}

/// A heap that comes to rest in substeps sleeps, and a soft body that falls on it belongs to it.
TEST(Substeps, ABallThatComesNearTakesBoxesOutOfTheirIsland) {
  World world = make_ground_world();
  for (int i = 0; i < 3; ++i) world.rigid.push_back(make_cube({0.0, 0.0, 1.0 + 2.02 * i}));
  SoftBody ball = make_body(make_sphere(1.5, 8, 8), {0.2, 0.0, 9.0});
  ball.material.n = 0.2;
  world.soft = {ball};
  Stepper stepper(world);
  bool met = false;
  for (int i = 0; i < 180; ++i) {
    ASSERT_FALSE(stepper.step(world));
    for (const Contact& contact : stepper.contacts()) {
      met = met || (contact.first.kind == SideKind::soft && contact.second.kind == SideKind::rigid);
    }
    ASSERT_LT(deepest(world), 0.02) << i;
  }
  EXPECT_TRUE(met);
}

/// A ball of gas, as one that is pumped up, carries ten boxes.
TEST(ManyPiles, ABallOfGasCarriesTenBoxesForAMinute) {
  World world = make_ground_world();
  SoftBody ball = make_body(make_sphere(4.0, 16, 16), {0.0, 0.0, 4.0});
  ball.material.n = 2.0;
  ball.material.rho_g = 0.05;
  world.soft = {ball};
  world.rigid = {make_rigid({6.0, 6.0, 0.3}, {0.0, 0.0, 8.6}, 4.0)};
  for (int i = 0; i < 9; ++i) {
    world.rigid.push_back(
        make_rigid(Vec3::Ones(), {1.3 * (i % 3 - 1), 1.3 * (i / 3 - 1), 9.6}, 0.5));
  }
  for (RigidBox& box : world.rigid) box.surface = {0.0, 0.8};
  ASSERT_FALSE(run(world, 60.0));
  for (const RigidBox& box : world.rigid) EXPECT_GT(box.position.z(), 1.0);
  EXPECT_LT(deepest(world), 0.02);
}

}  // namespace
}  // namespace pneuma::sim
