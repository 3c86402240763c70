// Obstacles of any shape: soft bodies of which all vertices are pinned.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>

#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/rotation.h"
#include "sim/soft/pins.h"
#include "tests/support/count_allocations.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

SoftBody make_obstacle(const TriangleMesh& mesh, const Vec3& position,
                       const Vec3& velocity = {0, 0, 0}, const Vec3& angular_velocity = {0, 0, 0}) {
  SoftBody body = make_body(mesh, position);
  body.name = "obstacle";
  body.material.n = 0.0;
  body.material.surface = {0.0, 0.5};
  const auto count = at(body.positions.size());
  GivenMotion motion;
  motion.position = position;
  motion.velocity = velocity;
  motion.angular_velocity = angular_velocity;
  const std::uint8_t moves = velocity.isZero() && angular_velocity.isZero() ? 0 : 1;
  body.pins = make_pins(body.positions, std::vector<std::uint8_t>(count, 1),
                        std::vector<std::uint8_t>(count, moves), motion);
  return body;
}

SoftBody make_ball(const Vec3& position) {
  SoftBody ball = make_body(make_icosphere(1.0, 2), position);
  ball.material.n = 0.1;
  ball.material.k = 60.0;
  ball.material.vertex_mass = 0.02;
  ball.material.surface = {0.0, 0.5};
  return ball;
}

bool are_same(const SoftBody& one, const SoftBody& other) {
  return one.positions.rows() == other.positions.rows() &&
         one.velocities.rows() == other.velocities.rows();
}

RigidBox make_slab(const Vec3& size, const Vec3& position) {
  RigidBox box = make_rigid(size, position);
  box.is_kinematic = true;
  box.surface = {0.0, 0.5};
  return box;
}

TEST(Obstacles, HoldABallAsAStaticBoxOfTheirShapeDoes) {
  const Vec3 size(6.0, 6.0, 1.0), place(0.0, 0.0, 3.0);
  World on_box, on_mesh;
  on_box.soft = {make_ball({0.2, 0.1, 4.7})};
  on_mesh.soft = on_box.soft;
  on_box.rigid = {make_slab(size, place)};
  on_mesh.soft.push_back(make_obstacle(make_box(size, 12), place));
  for (World* world : {&on_box, &on_mesh}) {
    world->soft[0].material.rho_g = 0.1;
    world->settings.steps_per_second = 240;
    ASSERT_FALSE(run(*world, 3.0));
    EXPECT_EQ(crossings(*world).between_bodies, 0);
  }
  // Their skins differ by hundredths of an edge.
  EXPECT_NEAR(mean(on_box.soft[0].positions).z(), mean(on_mesh.soft[0].positions).z(), 0.01);
  EXPECT_NEAR(mean(on_box.soft[0].positions).x(), mean(on_mesh.soft[0].positions).x(), 0.01);
}

TEST(Obstacles, StayToTheLastBitAndAreNoPartOfEnergyAndMomentum) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::sdirk2}) {
    World world;
    world.settings.integrator = integrator;
    world.settings.steps_per_second = 240;
    world.soft = {make_obstacle(make_torus(1.5, 0.8, 16, 12), {0.0, 0.0, 1.0}),
                  make_ball({0.2, 0.1, 2.6})};
    const VertexArray before = world.soft[0].positions;
    EXPECT_EQ(energy(world.soft[0], world.settings.gravity).total(), 0.0);
    Stepper stepper(world);
    for (int i = 0; i < 120; ++i) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->what;
      ASSERT_EQ(i % 8 == 0 ? crossings(world).between_bodies : 0, 0) << "after step " << i;
    }
    EXPECT_TRUE(world.soft[0].positions.rows() == before.rows());
    EXPECT_TRUE(world.soft[0].velocities.rows().isZero(0.0));
    EXPECT_GT(mean(world.soft[1].positions).z(), 1.3);  // above the hole, held by its rim
  }
}

TEST(Obstacles, ThatMoveTakeABoxAndABallAlong) {
  World world;
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.settings.steps_per_second = 240;
  world.soft = {make_obstacle(make_icosphere(1.0, 2), {-2.5, 0.0, 0.0}, {2.0, 0.0, 0.0}),
                make_ball({0.0, 0.0, 0.0})};
  world.rigid = {make_rigid({1.0, 4.0, 4.0}, {2.0, 0.0, 0.0}, 2.0)};
  Stepper stepper(world);
  for (int i = 0; i < 480; ++i) {
    const auto divergence = stepper.step(world);
    ASSERT_FALSE(divergence) << divergence->what;
    ASSERT_EQ(i % 8 == 0 ? crossings(world).between_bodies : 0, 0) << "after step " << i;
  }
  EXPECT_NEAR(mean(world.soft[0].positions).x(), 1.5, 1e-12);
  EXPECT_GT(mean(world.soft[1].positions).x(), 2.0);
  EXPECT_GT(world.rigid[0].velocity.x(), 0.5);
}

/// Triangles much smaller than those of the balls, with hills and hollows, at rest and moved.
TEST(Obstacles, ThatAreFineAreNotCrossed) {
  TriangleMesh mesh = make_icosphere(2.0, 4);
  for (Vec3& x : mesh.vertices) x *= 1.0 + 0.1 * std::sin(6.0 * x.x()) * std::cos(7.0 * x.y());
  const Vec3 zero = Vec3::Zero();
  for (const auto& [velocity, angular_velocity] :
       {std::pair(zero, zero), std::pair(Vec3(0.5, -0.3, 1.0), zero),
        std::pair(Vec3(0.5, -0.3, 1.0), Vec3(4.0, -6.0, 2.0)), std::pair(zero, Vec3(0, 0, 25))}) {
    for (const int subdivisions : {0, 1}) {
      World world;
      world.settings.ground.reset();
      world.settings.steps_per_second = 240;
      world.soft = {make_obstacle(mesh, {0.0, 0.0, 0.0}, velocity, angular_velocity),
                    make_body(make_icosphere(0.9, subdivisions), {0.3, 0.2, 3.4})};
      SoftBody& ball = world.soft[1];
      ball.material.n = 0.1;
      ball.material.k = 60.0;
      ball.material.vertex_mass = 0.02;
      for (int v = 0; v < ball.positions.size(); ++v) ball.velocities[v] = Vec3(1.0, 0.5, -10.0);
      Stepper stepper(world);
      std::size_t contacts = 0;
      for (int i = 0; i < 60; ++i) {
        const auto divergence = stepper.step(world);
        ASSERT_FALSE(divergence) << divergence->what;
        ASSERT_EQ(i % 4 == 0 ? crossings(world).between_bodies : 0, 0) << "after step " << i;
        contacts += stepper.contacts().size();
      }
      EXPECT_GT(contacts, 5u) << velocity.transpose() << ", " << angular_velocity.transpose();
    }
  }
}

/// A face on vertices of some of them, tilted by a hair against one or the other: to touch but the
/// nearest would let it rock.
TEST(Obstacles, HoldABoxThatLiesOnSeveral) {
  struct Fall {
    Vec3 size, turned, place;  // degrees
    double restitution, friction;
  };
  const Fall falls[] = {
      {{1.02, 0.58, 0.64}, {9.6, 8.9, -1.0}, {0.22, -0.30, 0.87}, 0.2, 1.0},
      {{0.968, 0.471, 0.905}, {-11.63, 13.75, 5.28}, {0.288, -0.046, 0.903}, 0.5, 0.8},
      {{0.815, 0.612, 0.503}, {-3.6, -14.3, -7.85}, {-0.288, -0.064, 0.769}, 0.0, 0.8},
      {{0.846, 0.694, 0.572}, {3.34, 7.09, -14.54}, {-0.069, -0.043, 0.818}, 0.5, 0.5}};
  for (const Fall& fall : falls) {
    World world;
    world.settings.ground.reset();
    world.settings.sleep_speed = 0.0;
    const ContactMaterial surface{fall.restitution, fall.friction};
    for (int i = 0; i < 9; ++i) {
      const Vec3 place(-1.23 + 1.3 * (i / 3), -1.33 + 1.3 * (i % 3), -0.8);
      world.soft.push_back(make_obstacle(make_icosphere(0.8, 1), place));
      world.soft.back().material.surface = surface;
    }
    RigidBox box = make_rigid(fall.size, fall.place);
    box.orientation = rotation_of_degrees(fall.turned);
    box.rho_g = 0.0;
    box.surface = surface;
    world.rigid = {box};
    ASSERT_FALSE(run(world, 8.0));
    EXPECT_LT(world.rigid[0].velocity.norm(), 1e-4) << fall.size.transpose();
    EXPECT_LT(world.rigid[0].angular_velocity.norm(), 1e-4) << fall.size.transpose();
  }
}

/// Two balls of different meshes that fall on it, and a box.
World make_fine_obstacle_world(const Vec3& angular_velocity, double speed) {
  World world;
  world.settings.ground.reset();
  world.settings.steps_per_second = 240;
  world.soft = {make_obstacle(make_icosphere(2.0, 4), {0, 0, 0}, {0, 0, 0}, angular_velocity),
                make_body(make_icosphere(0.5, 0), {0.6, 0.2, 2.7}),
                make_body(make_icosphere(0.5, 1), {-0.6, 0.2, 2.7})};
  for (SoftBody* ball : {&world.soft[1], &world.soft[2]}) {
    ball->material.n = 0.1;
    for (int v = 0; v < ball->positions.size(); ++v) ball->velocities[v].z() = -speed;
  }
  return world;
}

/// The second time, whatever balls of different meshes need is there.
TEST(Obstacles, ThatAreFineAllocateNothingTwice) {
  for (const Vec3& angular_velocity : {Vec3(0.0, 0.0, 0.0), Vec3(0.5, 0.2, 1.0)}) {
    const World start = make_fine_obstacle_world(angular_velocity, 5.0);
    World world = start;
    Stepper stepper(world);
    long before = 0;
    for (int run = 0; run < 2; ++run) {
      world = start;
      before = allocation_count();
      std::size_t contacts = 0;
      for (int i = 0; i < 60; ++i) {
        ASSERT_FALSE(stepper.step(world));
        contacts += stepper.contacts().size();
      }
      EXPECT_GT(contacts, 5u);
    }
    EXPECT_EQ(allocation_count() - before, 0);
  }
}

/// A step that someone looks into moves the obstacle's vertices with all others; another leaves
/// them until its end. At 26 m/s it is done in parts.
TEST(Obstacles, ThatAreMovedComeOutTheSameHoweverTheyAreLookedAt) {
  for (const double speed : {5.0, 26.0}) {
    World world = make_fine_obstacle_world({0.5, 0.2, 30.0}, speed);
    world.rigid = {make_rigid({0.4, 0.4, 0.4}, {0.0, -0.5, 2.4})};
    World looked_into = world;
    std::size_t parts = 0, contacts = 0;
    Stepper stepper(world);
    Stepper other(looked_into, {.plan = {}, .after_part = [&](const World&) { ++parts; }});
    for (int i = 0; i < 25; ++i) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->what;
      ASSERT_FALSE(other.step(looked_into));
      contacts += stepper.contacts().size();
      ASSERT_EQ(crossings(world).between_bodies, 0);
      for (std::size_t body = 0; body < world.soft.size(); ++body) {
        ASSERT_TRUE(are_same(world.soft[body], looked_into.soft[body])) << i;
      }
      ASSERT_EQ(world.rigid[0].position, looked_into.rigid[0].position);
    }
    EXPECT_GT(contacts, 5u);
    EXPECT_EQ(parts > 25, speed > 10.0) << parts;
  }
}

/// Whenever they are brought to where they are, and also after a step that fails.
TEST(Obstacles, ThatAreLeftBehindComeOutTheSame) {
  const World start = make_fine_obstacle_world({0.5, 0.2, 30.0}, 25.0);
  World world = start, behind = start;
  Stepper stepper(world), leaving(behind, {.plan = {}, .may_leave_obstacles = true});
  const auto expect_same = [&](const std::string& when) {
    leaving.place_obstacles(behind);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_TRUE(are_same(behind.soft[i], world.soft[i])) << when;
  };
  const auto run = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      ASSERT_FALSE(stepper.step(world));
      ASSERT_FALSE(leaving.step(behind));
      ASSERT_TRUE(are_same(world.soft[1], behind.soft[1])) << i;
      EXPECT_FALSE(are_same(world.soft[0], behind.soft[0])) << i;
    }
  };
  run(10);
  expect_same("after ten steps");
  run(15);
  const Vec3 position = behind.soft[1].positions[0];
  behind.soft[1].positions[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(leaving.step(behind));
  behind.soft[1].positions[0] = position;
  expect_same("after a step that failed");
  run(5);
  world = behind = start;
  run(20);
  expect_same("from the start again");
}

/// Whoever moves it by hand moves it away from where its motion would have it.
TEST(Obstacles, ThatLieElsewhereThanTheirMotionPutsThemAreNotCrossed) {
  World world = make_fine_obstacle_world({0.5, 0.2, 1.0}, 5.0);
  SoftBody& obstacle = world.soft[0];
  for (int v = 0; v < obstacle.positions.size(); ++v) obstacle.positions[v].z() += 0.1;
  Stepper stepper(world);
  for (int i = 0; i < 40; ++i) {
    ASSERT_FALSE(stepper.step(world));
    ASSERT_EQ(crossings(world).between_bodies, 0);
    if (i == 20) {
      for (SoftBody& body : world.soft) {
        for (int v = 0; v < body.positions.size(); ++v) body.positions[v].x() += 0.4;
      }
    }
  }
}

/// It begins to move long after all has come to rest, whether or not it is left behind.
TEST(Obstacles, ThatBeginToMoveWakeWhatSleepsOnThem) {
  World world;
  world.settings.steps_per_second = 240;
  SoftBody slab = make_obstacle(make_box({3.0, 3.0, 1.0}, 8), {0.0, 0.0, 2.0});
  GivenMotion motion;
  motion.position = {0.0, 0.0, 2.0};
  motion.keys.path = {{0.0, 0.0, 0.0, 0.0}, {8.0, 0.0, 0.0, 0.0}, {9.0, 0.0, 0.0, 1.0}};
  const auto count = at(slab.positions.size());
  slab.pins = make_pins(slab.positions, std::vector<std::uint8_t>(count, 1),
                        std::vector<std::uint8_t>(count, 1), motion);
  world.soft = {slab, make_ball({0.0, 0.0, 3.6})};
  world.soft[1].material.rho_g = 0.5;
  const World start = world;
  for (const bool may_leave : {false, true}) {
    world = start;
    Stepper stepper(world, {.plan = {}, .may_leave_obstacles = may_leave});
    for (int i = 0; i < 8 * 240; ++i) ASSERT_FALSE(stepper.step(world));
    ASSERT_GE(world.rest[1].group, 0);
    const double before = mean(world.soft[1].positions).z();
    for (int i = 0; i < 480; ++i) ASSERT_FALSE(stepper.step(world));
    EXPECT_NEAR(mean(world.soft[1].positions).z(), before + 1.0, 0.1);
    stepper.place_obstacles(world);
    EXPECT_NEAR(mean(world.soft[0].positions).z(), 3.0, 1e-9);
  }
}

TEST(Obstacles, MayLieInEachOtherAndInTheGround) {
  World world;
  world.soft = {make_obstacle(make_icosphere(1.0, 2), {0.0, 0.0, 0.0}),
                make_obstacle(make_icosphere(1.0, 1), {0.5, 0.0, 0.3})};
  world.rigid = {make_slab({1.0, 1.0, 1.0}, {0.0, 0.5, 0.0})};
  ASSERT_FALSE(run(world, 0.5));
  EXPECT_EQ(max_penetration(world), 0.0);
  EXPECT_EQ(crossings(world).between_bodies, 0);
}

}  // namespace
}  // namespace pneuma::sim
