// Swept contacts (ERRATA row 67): nothing passes through anything, momentum is kept, and all that
// contacts do to the energy is the work of their impulses.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/equilibrium/held_shape.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/rotation.h"
#include "tests/sim/swept/swept_worlds.h"
#include "tests/support/count_allocations.h"

namespace pneuma::sim {
namespace {

World make_free_swept_world() {
  World world = make_swept_world();
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  return world;
}

SoftBody make_smooth_ball(const Vec3& position, const Vec3& velocity) {
  SoftBody ball = make_ball(position, velocity);
  undamp(ball.material);
  ball.material.surface.friction = 0.0;
  return ball;
}

/// Expects of every step that it ends, with no body crossing another and every volume above zero.
void expect_apart(World& world, double seconds) {
  Stepper stepper(world);
  const int steps = static_cast<int>(seconds * world.settings.steps_per_second);
  for (int i = 0; i < steps; ++i) {
    const auto divergence = stepper.step(world);
    ASSERT_FALSE(divergence) << "step " << i << ": " << divergence->body << ": "
                             << divergence->what;
    ASSERT_EQ(crossings(world).between_bodies, 0) << "after step " << i;
    for (const SoftBody& body : world.soft) {
      ASSERT_GT(volume(body.mesh->topology, body.positions), 0.0) << "after step " << i;
    }
  }
}

TEST(Swept, ARodLaidOnABallStaysOnIt) {
  World world = make_swept_world();
  world.soft.push_back(make_ball({0.0, 0.0, 3.0}));
  world.rigid.push_back(make_rigid({12.0, 0.3, 0.3}, {0.2, 0.1, 8.0}, 5.0));
  expect_apart(world, 3.0);
  EXPECT_GT(world.rigid[0].position.z(), 3.0);
}

TEST(Swept, APlateOnEdgeDoesNotCutABall) {
  for (int i = 0; i < 4; ++i) {
    World world = make_swept_world();
    world.soft.push_back(make_ball({0.0, 0.0, 3.0}));
    RigidBox plate = make_rigid({4.0, 0.1, 4.0}, {0.3 * i, 0.25 * i, 8.3}, 2.0);
    plate.velocity = {0.0, 0.0, -2.0};
    world.rigid.push_back(plate);
    expect_apart(world, 1.0);
    EXPECT_GT(world.rigid[0].position.z(), 2.0) << i;
  }
}

TEST(Swept, AHeavyBoxPressesABallFlatAndDoesNotEnterIt) {
  World world = make_swept_world();
  world.soft.push_back(make_ball({0.0, 0.0, 3.0}));  // 20 kg
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {0.0, 0.0, 8.0}, 200.0));
  expect_apart(world, 4.0);
  EXPECT_GT(world.rigid[0].position.z(), 1.005) << "nothing is left between it and the ground";
}

TEST(Swept, BallsShotAtEachOtherBounceApart) {
  for (const double speed : {2.0, 10.0, 30.0}) {
    for (const int steps_per_second : {60, 240}) {
      for (const double aside : {0.0, 0.35, 1.1}) {
        SCOPED_TRACE(testing::Message()
                     << speed << " m/s, " << steps_per_second << " steps/s, " << aside << " m");
        World world = make_free_swept_world();
        world.settings.steps_per_second = steps_per_second;
        world.soft = {make_ball({0.0, -4.0, 0.0}, {0.0, speed, 0.0}),
                      make_ball({aside, 4.0, 0.1}, {0.0, -speed, 0.0})};
        expect_apart(world, 1.0);
        const Vec3 apart = mean(world.soft[1].positions) - mean(world.soft[0].positions);
        EXPECT_GT(apart.norm(), 3.0) << "one is in the other";
        if (aside == 0.0) {
          EXPECT_GT(apart.y(), 0.0) << "they have changed places";
        }
      }
    }
  }
}

/// Of 5 kg, whose springs balance its gas.
SoftBody make_held_ball(const TriangleMesh& mesh, double k, double n) {
  SoftBody ball = make_body(mesh);
  ball.material.k = k;
  ball.material.n = n;
  ball.material.vertex_mass = 5.0 / ball.positions.size();
  ball.material.rho_g = 0.1;
  ball.material.surface.restitution = 0.0;
  ball.mesh = held_mesh(*ball.mesh, ball.positions, ball.material);
  return ball;
}

/// Drag slows them until they hardly move, and springs push them apart from there.
TEST(Swept, BallsThatPressEachOtherInTheAirPart) {
  for (const Integrator integrator : {Integrator::martin, Integrator::symplectic_euler,
                                      Integrator::velocity_verlet, Integrator::rk4}) {
    World world = make_free_swept_world();
    world.settings.integrator = integrator;
    world.settings.steps_per_second = 1200;
    const SoftBody soft = make_held_ball(make_icosphere(1.0, 2), 187.0, 0.05);
    SoftBody firm = make_held_ball(make_sphere(1.0, 12, 12), 4686.0, 0.13);
    for (int v = 0; v < firm.positions.size(); ++v) {
      firm.positions[v] += Vec3(0.1, 0.2, 2.3);
      firm.velocities[v].z() = -4.0;
    }
    world.soft = {soft, firm};
    Stepper stepper(world);
    for (int i = 0; i < 2400; ++i) ASSERT_FALSE(stepper.step(world));
    EXPECT_TRUE(stepper.contacts().empty());
    EXPECT_NEAR(volume_of(world.soft[0]) / volume_of(soft), 1.0, 1e-3);
  }
}

/// Of methods whose new velocity moves bodies: what holds the ball is taken again by its forces.
TEST(Swept, ContactsAtRestDoNoWork) {
  for (const Integrator integrator :
       {Integrator::martin, Integrator::symplectic_euler, Integrator::implicit_euler}) {
    World world = make_swept_world();
    world.settings.integrator = integrator;
    world.settings.steps_per_second = 600;
    world.settings.sleep_speed = 0.0;
    SoftBody ball = make_held_ball(make_icosphere(1.0, 2), 400.0, 0.2);
    ball.material.rho_g = 0.3;
    for (int v = 0; v < ball.positions.size(); ++v) ball.positions[v].z() += 2.05;
    world.soft = {ball};
    world.rigid = {make_rigid({4.0, 4.0, 1.0}, {0.0, 0.0, 0.5})};
    world.rigid[0].is_kinematic = true;
    Stepper stepper(world, {.measure_work = true, .plan = {}});
    double work = 0.0;
    for (int i = 0; i < 1800; ++i) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->what;
      if (i >= 1500) work += std::abs(stepper.contact_work());
    }
    EXPECT_FALSE(stepper.contacts().empty());
    EXPECT_LT(work, 1e-3) << "J, by method " << static_cast<int>(integrator);
  }
}

TEST(Swept, FastCubesDoNotPassEachOther) {
  for (int phase = 0; phase < 12; ++phase) {
    World world = make_free_swept_world();
    world.rigid = {make_rigid(Vec3::Ones(), {0.0, 0.0, -4.0 - 0.13 * phase}),
                   make_rigid(Vec3::Ones(), {0.05, 0.1, 4.0})};
    world.rigid[0].velocity = {0.0, 0.0, 50.0};
    world.rigid[1].velocity = {0.0, 0.0, -50.0};
    expect_apart(world, 0.3);
    EXPECT_LT(world.rigid[0].position.z(), world.rigid[1].position.z()) << phase;
  }
}

/// Cubes in a row, the first of which moves, without loss.
World make_row(double gap) {
  World world = make_free_swept_world();
  for (int i = 0; i < 3; ++i) {
    RigidBox cube = make_rigid(Vec3::Ones(), {0.0, 0.0, (1.0 + gap) * i});
    cube.surface = {1.0, 0.0};
    cube.rho_g = 0.0;
    world.rigid.push_back(cube);
  }
  world.rigid[0].velocity = {0.0, 0.0, 5.0};
  return world;
}

TEST(Swept, ARowOfCubesHandsOnItsEnergyFromEveryDistance) {
  for (int i = 0; i < 20; ++i) {
    World world = make_row(0.3 + 0.005 * i);
    const double before = energy(world).kinetic;
    expect_apart(world, 0.5);
    EXPECT_NEAR(energy(world).kinetic, before, 1e-6 * before) << i;
    EXPECT_NEAR(world.rigid[2].velocity.z(), 5.0, 1e-5) << i;
  }
}

TEST(Swept, ACubeThatIsPushedIntoTheGroundGainsNoEnergy) {
  for (const double gap : {0.02, 0.03, 0.05, 0.1}) {
    World world = make_row(1.0);
    world.settings.ground = ContactMaterial{1.0, 0.0};
    world.rigid.pop_back();
    world.rigid[0].position.z() = 0.5 + gap;
    world.rigid[1].position.z() = 3.0;
    world.rigid[0].velocity.setZero();
    world.rigid[1].velocity = {0.0, 0.0, -6.0};
    Stepper stepper(world);
    const double before = energy(world).kinetic;
    for (int k = 0; k < 30; ++k) {
      ASSERT_FALSE(stepper.step(world));
      EXPECT_LE(energy(world).kinetic, before * (1.0 + 1e-9)) << gap << " m, step " << k;
    }
  }
}

TEST(Swept, CubesDoTheSameBesideABallThatIsFarAway) {
  World alone = make_row(0.4), beside = make_row(0.4);
  beside.soft.push_back(make_ball({100.0, 0.0, 0.0}));
  Stepper one(alone), other(beside);
  for (int i = 0; i < 30; ++i) {
    ASSERT_FALSE(one.step(alone));
    ASSERT_FALSE(other.step(beside));
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(alone.rigid[at(k)].position, beside.rigid[at(k)].position) << i;
    }
  }
}

TEST(Swept, CubesThatTouchAtTheStartStandOnEachOther) {
  for (const double gap : {0.0, 1e-12}) {
    World world = make_swept_world();
    for (int i = 0; i < 4; ++i) {
      world.rigid.push_back(make_rigid(Vec3::Ones(), {0.1 * i, 0.0, 0.5 + (1.0 + gap) * i}));
    }
    expect_apart(world, 2.0);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(world.rigid[at(i)].position.z(), 0.5 + i, 0.03) << i;
      EXPECT_NEAR(world.rigid[at(i)].position.x(), 0.1 * i, 0.03) << i;
    }
  }
}

TEST(Swept, AnImpactKeepsLinearAndAngularMomentum) {
  World world = make_free_swept_world();
  // Of the integrators the one that keeps angular momentum by itself, whatever the step.
  world.settings.integrator = Integrator::symplectic_euler;
  world.soft = {make_smooth_ball({0.0, -4.0, 0.0}, {0.0, 20.0, 0.0}),
                make_smooth_ball({1.5, 4.0, 0.1}, {0.0, -20.0, 0.0})};
  RigidBox box = make_rigid({1.0, 2.0, 3.0}, {-5.0, 0.3, 0.2}, 4.0);
  box.rho_g = 0.0;
  box.surface.friction = 0.0;
  box.velocity = {6.0, 0.0, 0.0};
  world.rigid.push_back(box);
  const Momentum before = momentum(world);
  double scale = 0.0;  // of the parts, which cancel
  for (const SoftBody& ball : world.soft) scale += momentum(ball).linear.norm();

  Stepper stepper(world);
  std::size_t contacts = 0;
  for (int i = 0; i < 60; ++i) {
    ASSERT_FALSE(stepper.step(world));
    contacts += stepper.contacts().size();
  }
  EXPECT_GT(contacts, 50u);
  EXPECT_LT((momentum(world).linear - before.linear).norm(), 1e-13 * scale);
  EXPECT_LT((momentum(world).angular - before.angular).norm(), 1e-10 * scale * 3.0);
}

/// A box that spins rubs on a ball: friction acts on both at one point, however far apart they are.
TEST(Swept, FrictionOnABoxKeepsAngularMomentum) {
  World world = make_free_swept_world();
  world.settings.integrator = Integrator::symplectic_euler;  // as above
  world.settings.steps_per_second = 240;
  SoftBody ball = make_smooth_ball({0.0, 5.0, 0.2}, {2.0, -5.0, 0.0});
  ball.material.surface.friction = 0.5;
  world.soft = {ball};
  RigidBox box = make_rigid({2.0, 2.0, 2.0}, Vec3::Zero(), 100.0);
  box.rho_g = 0.0;
  box.angular_velocity = {0.0, 1.0, 5.0};
  world.rigid = {box};
  const Momentum before = momentum(world);
  ASSERT_FALSE(run(world, 1.0));
  const double turned = (world.rigid[0].angular_velocity - box.angular_velocity).norm();
  EXPECT_GT(turned, 0.1);
  EXPECT_LT((momentum(world).angular - before.angular).norm(), 1e-11 * before.angular.norm());
}

/// Points without forces between them, and cubes, which turn evenly: contacts alone change energy.
TEST(Swept, ContactsChangeTheEnergyByTheWorkOfTheirImpulses) {
  World world = make_free_swept_world();
  world.soft = {make_ball({0.0, -3.5, 0.0}, {0.0, 5.0, 0.0}),
                make_ball({1.0, 3.5, 0.1}, {0.0, -5.0, 0.0})};
  for (SoftBody& ball : world.soft) {
    undamp(ball.material);
    ball.material.k = 0.0;
    ball.material.n = 0.0;
  }
  world.rigid = {make_rigid({1.0, 1.0, 1.0}, {4.0, 0.2, 0.1}, 2.0),
                 make_rigid({1.0, 1.0, 1.0}, {7.0, 0.1, 0.2}, 3.0)};
  for (RigidBox& box : world.rigid) box.rho_g = 0.0;
  world.rigid[0].velocity = {-8.0, 0.0, 0.0};
  world.rigid[1].velocity = {-20.0, 0.0, 0.0};
  world.rigid[0].angular_velocity = {1.0, -2.0, 3.0};

  Stepper stepper(world, {.measure_work = true, .plan = {}});
  const double start = energy(world).kinetic;
  double booked = 0.0;
  for (int i = 0; i < 40; ++i) {
    const double before = energy(world).kinetic;
    ASSERT_FALSE(stepper.step(world));
    EXPECT_NEAR(energy(world).kinetic - before, stepper.contact_work(), 1e-12 * start);
    EXPECT_LE(stepper.contact_work(), 1e-12 * start) << "contacts gave energy";
    booked += stepper.contact_work();
  }
  EXPECT_LT(booked, -0.01 * start) << "nothing touched";
}

/// A cube and a needle that turn while they meet: what the impulses at the ends of a step would add
/// is taken from their motion against each other.
TEST(Swept, FastImpactsOfTurningBoxesKeepMomentumAndGainNothing) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto any_vector = [&] { return Vec3(any(random), any(random), any(random)); };
  int hits = 0;
  for (int i = 0; i < 40; ++i) {
    World world = make_free_boxes({make_rigid(Vec3::Ones(), {-2.0, 0.0, 0.0}, 1.0),
                                   make_rigid({0.1, 0.1, 3.0}, {2.0, 0.0, 0.0}, 0.5)},
                                  1.0);
    world.settings.contact = ContactMethod::swept;
    for (RigidBox& box : world.rigid) {
      box.position.y() = 0.3 * any(random);
      box.orientation = rotation_of_degrees(180.0 * any_vector());
      box.velocity = Vec3(box.position.x() > 0.0 ? -80.0 : 80.0, 0.0, 0.0);
      box.angular_velocity = 10.0 * any_vector();
    }
    const double start = energy(world).kinetic;
    const Momentum before = momentum(world);
    Stepper stepper(world, {.measure_work = true, .plan = {}});
    for (int step = 0; step < 6; ++step) {
      ASSERT_FALSE(stepper.step(world)) << i;
      EXPECT_LE(stepper.contact_work(), 1e-12 * start) << i;
      hits += stepper.contacts().empty() ? 0 : 1;
    }
    // Of the parts, which cancel: 80 kg m/s, 2 m from the origin.
    EXPECT_LT((momentum(world).linear - before.linear).norm(), 1e-13 * 80.0) << i;
    EXPECT_LT((momentum(world).angular - before.angular).norm(), 1e-10 * 160.0) << i;
  }
  EXPECT_GT(hits, 30);
}

/// What rounding leaves is no energy that contacts add.
TEST(Swept, BoxesThatTouchAtRestGoOnInWhateverFrame) {
  for (const double speed : {0.0, 1.0}) {
    World world = make_free_boxes({make_rigid(Vec3::Ones(), Vec3::Zero(), 2.0),
                                   make_rigid(Vec3::Ones(), {0.2, 0.0, 1.0}, 2.0)},
                                  0.5);
    world.settings.contact = ContactMethod::swept;
    world.settings.sleep_speed = 0.0;
    for (RigidBox& box : world.rigid) {
      box.surface.friction = 0.5;
      box.velocity.x() = speed;
    }
    const auto divergence = run(world, 1.0);
    EXPECT_FALSE(divergence) << divergence->what;
  }
}

TEST(Swept, RestitutionIsTheRatioOfSpeedsAtEveryStep) {
  for (const double restitution : {0.0, 0.2, 0.5, 1.0}) {
    for (const int steps_per_second : {60, 240, 960}) {
      World world = make_free_boxes({make_rigid(Vec3::Ones(), {0.0, 0.0, -2.0}, 1.0),
                                     make_rigid({2.0, 2.0, 1.0}, {0.0, 0.0, 2.0}, 3.0)},
                                    restitution);
      world.settings.contact = ContactMethod::swept;
      world.settings.steps_per_second = steps_per_second;
      world.rigid[0].velocity = {0.0, 0.0, 5.0};
      world.rigid[1].velocity = {0.0, 0.0, -3.0};
      ASSERT_FALSE(run(world, 1.0));
      const double apart = world.rigid[1].velocity.z() - world.rigid[0].velocity.z();
      EXPECT_NEAR(apart, restitution * 8.0, 0.02 * 8.0 * restitution + 1e-3)
          << restitution << " at " << steps_per_second;
    }
  }
}

TEST(Swept, ABoxDroppedFlatKeepsItsHeightWithoutLoss) {
  World world = make_swept_world();
  world.settings.ground = ContactMaterial{1.0, 0.0};
  world.rigid.push_back(make_rigid(Vec3::Ones(), {0.0, 0.0, 1.5}));
  world.rigid[0].rho_g = 0.0;
  Stepper stepper(world);
  double highest = 0.0;
  for (int i = 0; i < 20 * world.settings.steps_per_second; ++i) {
    ASSERT_FALSE(stepper.step(world));
    if (time(world) > 19.0) highest = std::max(highest, world.rigid[0].position.z() - 0.5);
  }
  EXPECT_NEAR(highest, 1.0, 0.02);
}

TEST(Swept, AStackOfFiveStands) {
  World world = make_swept_world();
  for (int i = 0; i < 5; ++i) {
    world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {0.05 * i, 0.0, 1.0 + 2.02 * i}));
  }
  expect_apart(world, 5.0);
  for (int i = 0; i < 5; ++i) {
    const RigidBox& box = world.rigid[at(i)];
    EXPECT_NEAR(box.position.x(), 0.05 * i, 0.05) << i;
    EXPECT_NEAR(box.position.z(), 1.0 + 2.01 * i, 0.03) << i;
  }
}

TEST(Swept, FrictionHoldsBelowItsAngleAndLetsSlideAboveIt) {
  const auto slid = [](double tangent) {
    World world = make_swept_world();
    world.settings.ground = ContactMaterial{0.0, 0.5};
    world.settings.gravity = 9.81 * Vec3(tangent, 0.0, -1.0).normalized();
    world.rigid.push_back(make_rigid({2.0, 2.0, 1.0}, {0.0, 0.0, 0.5}));
    world.rigid[0].rho_g = 0.0;
    EXPECT_FALSE(run(world, 2.0));
    return world.rigid[0].position.x();
  };
  EXPECT_LT(slid(0.49), 0.01);
  // g (sin - mu cos) t^2 / 2 with tan = 0.6
  EXPECT_NEAR(slid(0.6), 9.81 * 0.1 / std::hypot(1.0, 0.6) * 2.0, 0.05);
}

TEST(Swept, ContinuesBitForBitFromACopyAndOverThreads) {
  World world = make_swept_world();
  world.soft = {make_ball({0.0, 0.0, 3.1}), make_ball({0.5, 0.3, 9.4})};
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {5.0, 0.0, 8.0}));
  ASSERT_FALSE(run(world, 0.5));
  EXPECT_EQ(state_hash_after(world, 0.5, 1), state_hash_after(world, 0.5, 3));
}

TEST(Swept, AllocatesNothingOnceTheContactsHavePeaked) {
  World world = make_swept_world();
  world.soft.push_back(make_ball({0.0, 0.0, 3.0}));
  world.rigid = {make_rigid({2.0, 2.0, 2.0}, {8.0, 0.0, 1.0}),
                 make_rigid({2.0, 2.0, 2.0}, {8.0, 0.0, 3.02})};
  Stepper stepper(world);
  for (int i = 0; i < 600; ++i) ASSERT_FALSE(stepper.step(world));
  const long before = allocation_count();
  for (int i = 0; i < 300; ++i) ASSERT_FALSE(stepper.step(world));
  EXPECT_EQ(allocation_count() - before, 0);
}

TEST(Swept, LeavesOutWhatTheImpulsesOfThePaperNeed) {
  World world = make_swept_world();
  world.soft = {make_ball({0.0, 0.0, 3.1}), make_ball({0.5, 0.3, 9.4})};
  const Plan plan = make_plan(world);
  EXPECT_FALSE(plan.runs(Stage::broad_phase));
  EXPECT_FALSE(plan.runs(Stage::move_particles));
  EXPECT_FALSE(plan.runs(Stage::depenetrate));
  ASSERT_FALSE(run(world, 0.5));
  EXPECT_TRUE(world.particles.empty());
}

}  // namespace
}  // namespace pneuma::sim
