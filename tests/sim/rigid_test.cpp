#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sim/inspect/inspect.h"
#include "sim/rigid/inertia.h"
#include "sim/rigid/rigid_motion.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

constexpr double pi = std::numbers::pi;

/// A box that spins mostly about its middle axis, which is the unstable one: it tumbles.
RigidBox tumbling_box() {
  RigidBox box = make_rigid({1.0, 2.0, 3.0}, Vec3::Zero(), 2.0);
  box.rho_g = 0.0;
  box.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()));
  box.angular_velocity = box.orientation * Vec3(0.3, 2.0 * pi, 0.2);  // a turn a second
  return box;
}

double spin_energy(const RigidBox& box) { return 0.5 * box.angular_velocity.dot(spin(box)); }

/// The greatest deviation of the energy from the start's, over `turns` of a second each.
double energy_error(int steps_per_second, int turns) {
  RigidBox box = tumbling_box();
  const double start = spin_energy(box);
  double worst = 0.0;
  for (int i = 0; i < turns * steps_per_second; ++i) {
    move_freely(box, Vec3::Zero(), 1.0 / steps_per_second);
    worst = std::max(worst, std::abs(spin_energy(box) / start - 1.0));
  }
  return worst;
}

TEST(RigidMotion, ATumblingBoxKeepsItsAngularMomentum) {
  RigidBox box = tumbling_box();
  const Vec3 start = spin(box);
  const double start_energy = spin_energy(box);
  double drift = 0.0, unit = 0.0, flips = 0.0, energy_drift = 0.0;
  double side = 1.0;
  for (int i = 0; i < 1000 * 60; ++i) {
    move_freely(box, Vec3::Zero(), 1.0 / 60.0);
    drift = std::max(drift, (spin(box) - start).norm() / start.norm());
    unit = std::max(unit, std::abs(box.orientation.norm() - 1.0));
    energy_drift = std::max(energy_drift, std::abs(spin_energy(box) / start_energy - 1.0));
    const double now = (box.orientation.conjugate() * box.angular_velocity).y();
    if (now * side < 0.0) {
      side = now;
      ++flips;
    }
  }
  EXPECT_LT(drift, 1e-10);  // 60,000 steps of a few roundings each, mostly of one sign at worst
  EXPECT_LT(unit, 1e-15);
  EXPECT_GT(flips, 100)
      << "it is the unstable axis: were it not to tumble, nothing would be tested";
  RecordProperty("energy_drift_in_1000_turns", std::to_string(energy_drift));
  // The method's error, (omega h)^2 = 0.011 times a factor below one; the next test has its order.
  EXPECT_LT(energy_drift, 1e-3);
}

TEST(RigidMotion, TheEnergyErrorIsOfSecondOrderAndDoesNotAddUp) {
  // The step is symplectic: the energy of a system that differs by terms in h^2 is kept for ever.
  for (const int steps_per_second : {60, 120, 240}) {
    const double error = energy_error(steps_per_second, 10);
    RecordProperty("energy_error_at_" + std::to_string(steps_per_second), std::to_string(error));
    // The terms in h^4, relative to those in h^2, are again (omega h)^2 = 0.011 at 60 steps.
    EXPECT_NEAR(energy_error(2 * steps_per_second, 10) / error, 0.25, 0.005);
    // The greatest of a hundred times as many moments is a little greater.
    EXPECT_NEAR(energy_error(steps_per_second, 1000) / error, 1.0, 0.01);
  }
}

/// By more than a radian in each step.
TEST(RigidMotion, AFastSpinKeepsItsEnergy) {
  RigidBox box = make_rigid({3.0, 0.1, 0.1}, Vec3::Zero(), 1.0);
  box.rho_g = 0.0;
  for (const double speed : {15.0, 100.0, 1000.0}) {
    box.orientation.setIdentity();
    box.angular_velocity = {0.5 * speed, 3.0, speed};
    const double start = spin_energy(box);
    double worst = 0.0;
    for (int i = 0; i < 180; ++i) {
      move_freely(box, Vec3::Zero(), 1.0 / 60.0);
      worst = std::max(worst, std::abs(spin_energy(box) / start - 1.0));
    }
    EXPECT_LT(worst, 2e-3) << speed;  // of second order in what it turns by in a part of a step
  }
}

TEST(RigidMotion, DragIsThatOfTheClosedFormWhateverTheStep) {
  const Vec3 gravity(0.0, 0.0, -9.81), start(3.0, 0.0, 5.0);
  for (const double rho_g : {0.0, 1e-12, 0.01, 0.3}) {
    const double rate = -60.0 * std::log(1.0 - rho_g);
    for (const int steps : {1, 60, 960}) {
      RigidBox box = make_rigid({1.0, 1.0, 1.0}, Vec3::Zero());
      box.rho_g = rho_g;
      box.velocity = start;
      for (int i = 0; i < steps; ++i) move_freely(box, gravity, 1.0 / steps);
      const Vec3 expected =
          rho_g < 1e-6  // then to the first order
              ? Vec3(start * (1.0 - rate) + gravity * (1.0 - 0.5 * rate))
              : Vec3(std::exp(-rate) * start + (1.0 - std::exp(-rate)) / rate * gravity);
      EXPECT_LT((box.velocity - expected).norm(), 1e-11) << rho_g << ' ' << steps;
    }
  }
}

/// A rod's least moment is a thousandth of the others: a little of the angular momentum across it,
/// on its own axis, would be many times its energy.
TEST(RigidMotion, AThinRodKeepsItsEnergy) {
  for (const Vec3& size : {Vec3(0.05, 4.0, 0.05), Vec3(0.05, 4.0, 0.06), Vec3(0.05, 4.0, 0.2)}) {
    RigidBox rod = make_rigid(size, Vec3::Zero(), 1.0);
    rod.rho_g = 0.0;
    rod.angular_velocity = {10.0, 30.0, 0.0};
    const double start = spin_energy(rod);
    for (int i = 0; i < 600; ++i) {
      move_freely(rod, Vec3::Zero(), 1.0 / 60.0);
      // Of second order in what it turns by in a part of a step, and in how far it is from a top.
      ASSERT_NEAR(spin_energy(rod) / start, 1.0, size.x() == size.z() ? 1e-10 : 1e-4) << i;
    }
  }
}

/// With I across it and J about it a top turns about its axis by (1 / J - 1 / I) L_axis t and then
/// about the angular momentum L by |L| t / I.
TEST(RigidMotion, ATopPrecessesAsTheClosedFormSays) {
  RigidBox top = make_rigid({1.0, 1.0, 0.2}, Vec3::Zero(), 2.0);
  top.rho_g = 0.0;
  top.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Vec3(1.0, 2.0, 0.5).normalized()));
  top.angular_velocity = {1.0, -2.0, 7.0};
  const Vec3 momentum = spin(top), inertia = body_inertia(top);
  const Vec3 axis = top.orientation * Vec3::UnitZ();
  const double own = momentum.dot(axis) * (1.0 / inertia.z() - 1.0 / inertia.x());
  const Eigen::Quaterniond expected =
      Eigen::AngleAxisd(momentum.norm() / inertia.x(), momentum.normalized()) *
      Eigen::AngleAxisd(own, axis) * top.orientation;
  for (int i = 0; i < 10; ++i) move_freely(top, Vec3::Zero(), 0.1);
  EXPECT_LT(top.orientation.angularDistance(expected), 1e-12);
}

TEST(RigidMotion, ACubeTurnsEvenly) {
  RigidBox cube = make_rigid({2.0, 2.0, 2.0}, Vec3::Zero());
  cube.rho_g = 0.0;
  cube.angular_velocity = {0.3, -1.1, 2.0};
  const Vec3 before = cube.angular_velocity;
  for (int i = 0; i < 600; ++i) move_freely(cube, Vec3::Zero(), 1.0 / 60.0);
  EXPECT_EQ(cube.angular_velocity, before);
  // Turned by |omega| times 10 s about omega: 600 steps of a rounding each.
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(10.0 * before.norm(), before.normalized()));
  EXPECT_LT(cube.orientation.angularDistance(expected), 1e-12);
}

TEST(RigidMotion, ABoxTurnsEvenlyAboutItsOwnAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    RigidBox box = make_rigid({1.0, 2.0, 3.0}, Vec3::Zero());
    box.rho_g = 0.0;
    box.angular_velocity[axis] = 5.0;
    for (int i = 0; i < 60; ++i) move_freely(box, Vec3::Zero(), 1.0 / 60.0);
    // About the middle axis a rounding grows as exp(lambda t), lambda = 5 sqrt(24/65) or e^3 in 1
    // s.
    EXPECT_LT((box.angular_velocity - 5.0 * Vec3::Unit(axis)).norm(), 1e-13) << axis;
    const Eigen::Quaterniond expected(Eigen::AngleAxisd(5.0, Vec3::Unit(axis)));
    EXPECT_LT(box.orientation.angularDistance(expected), 1e-13) << axis;
  }
}

TEST(RigidMotion, TheTumblingFollowsEulersEquations) {
  // I domega/dt + omega x I omega = 0 in body axes, by classical Runge-Kutta in tiny steps.
  RigidBox box = tumbling_box();
  const Vec3 inertia = body_inertia(box);
  const auto rate = [&inertia](const Vec3& w) -> Vec3 {
    return -w.cross(inertia.cwiseProduct(w)).cwiseQuotient(inertia);
  };
  Vec3 expected = box.orientation.conjugate() * box.angular_velocity;
  constexpr int fine = 10'000, steps = 6'000;
  for (int i = 0; i < fine; ++i) {
    const double h = 1.0 / fine;
    const Vec3 k1 = rate(expected), k2 = rate(expected + 0.5 * h * k1);
    const Vec3 k3 = rate(expected + 0.5 * h * k2), k4 = rate(expected + h * k3);
    expected += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  for (int i = 0; i < steps; ++i) move_freely(box, Vec3::Zero(), 1.0 / steps);
  // Second order: (omega h)^2 = 1.1e-6 of 6.3 rad/s, times the instability's e^4.
  EXPECT_LT((box.orientation.conjugate() * box.angular_velocity - expected).norm(), 1e-4);
}

TEST(RigidMotion, NoRotationIsNoNaN) {
  RigidBox box = make_rigid({1.0, 2.0, 3.0}, Vec3::Zero());
  move_freely(box, {0.0, 0.0, -g}, 1.0 / 60.0);
  EXPECT_EQ(box.orientation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
  EXPECT_EQ(box.angular_velocity, Vec3::Zero());
  EXPECT_EQ(turned(box.orientation, Vec3::Zero()).coeffs(), box.orientation.coeffs());
  // So small that its square underflows: the same as none.
  EXPECT_TRUE(turned(box.orientation, Vec3::Constant(1e-200)).coeffs().allFinite());
}

TEST(RigidMotion, FallsByTheRecurrenceOfEulerCromer) {
  // Alternately p += v h and v' = g - gamma v for h, beginning with p.
  World world = make_free_boxes({make_rigid({1.0, 2.0, 3.0}, {0.0, 0.0, 50.0})}, 0.0);
  world.settings.contact = ContactMethod::impulses;
  world.settings.gravity = {0.0, 0.0, -g};
  world.rigid[0].rho_g = 0.01;
  world.rigid[0].velocity = {3.0, 0.0, 10.0};
  constexpr double h = 1.0 / 60.0;
  // v_n = v_inf + (v_0 - v_inf) s^n with s = 0.99 and v_inf = -g / gamma; the places are the
  // geometric series' sums.
  const double s = 0.99, limit = g / (60.0 * std::log(s));
  Stepper stepper(world);
  for (int n = 1; n <= 240; ++n) {
    ASSERT_FALSE(stepper.step(world));
    const double power = std::pow(s, n), sum = (1.0 - power) / (1.0 - s);
    const Vec3 velocity(3.0 * power, 0.0, limit + (10.0 - limit) * power);
    const Vec3 position(3.0 * h * sum, 0.0, 50.0 + h * (n * limit + (10.0 - limit) * sum));
    ASSERT_LT((world.rigid[0].velocity - velocity).norm(), 1e-12);  // roundings of 240 steps
    ASSERT_LT((world.rigid[0].position - position).norm(), 1e-11);
  }
}

/// Of two boxes: in flight beside each other, or one alone in empty space.
World boxes_in_flight(bool alone) {
  std::vector<RigidBox> boxes = {make_rigid({1.0, 2.0, 3.0}, {0.0, 0.0, 50.0})};
  if (!alone) boxes.push_back(make_rigid({1.0, 1.0, 1.0}, {9.0, 0.0, 50.0}));
  World world = make_free_boxes(std::move(boxes), 0.0);
  if (!alone) world.settings.ground.emplace();
  world.settings.gravity = {0.0, 0.0, -g};
  for (RigidBox& box : world.rigid) {
    box.velocity = {3.0, 0.0, 10.0};
    box.angular_velocity = {0.0, 0.0, 1.0};
  }
  return world;
}

TEST(RigidMotion, WithoutDragAFlightIsAParabolaAndKeepsItsEnergy) {
  for (const bool alone : {true, false}) {
    World world = boxes_in_flight(alone);
    const double before = energy(world).total();
    ASSERT_FALSE(run(world, 2.0));
    const Vec3 way(3.0 * 2.0, 0.0, 10.0 * 2.0 - 0.5 * g * 2.0 * 2.0);
    EXPECT_LT((world.rigid[0].position - Vec3(0.0, 0.0, 50.0) - way).norm(), 1e-12);
    EXPECT_NEAR(energy(world).total(), before, 1e-12 * before);  // a rounding per step
  }
}

TEST(RigidMotion, DragTakesItsShareInASixtiethOfASecondWhateverTheStep) {
  for (const int steps_per_second : {60, 120, 960}) {
    World world = make_free_boxes({make_rigid({1.0, 1.0, 1.0}, Vec3::Zero())}, 0.0);
    world.settings.steps_per_second = steps_per_second;
    world.rigid[0].rho_g = 0.25;
    world.rigid[0].velocity = {8.0, 0.0, 0.0};
    world.rigid[0].angular_velocity = {0.0, 4.0, 0.0};
    ASSERT_FALSE(run(world, 1.0 / 60.0));
    EXPECT_NEAR(world.rigid[0].velocity.x(), 6.0, 1e-14);  // a rounding per step
    EXPECT_NEAR(world.rigid[0].angular_velocity.y(), 3.0, 1e-14);
  }
}

TEST(RigidCollision, HeadOnFollowsTheClosedForm) {
  // Momentum is kept and the speed of parting is epsilon times that of approach:
  // v0' = (m0 u0 + m1 u1 + m1 epsilon (u1 - u0)) / (m0 + m1), and likewise for v1'.
  // The four points of the faces are corrected in turns: until the corrections are 1e-6 of the
  // impulse, or for the default ten iterations.
  struct Accuracy {
    int iterations;
    double tolerance;
  };
  for (const Accuracy accuracy :
       {Accuracy{1000, 1e-4}, Accuracy{Settings{}.contact_iterations, 4e-3}}) {
    for (const double m1 : {1.0, 5.0, 0.01}) {
      for (const double epsilon : {0.0, 0.5, 1.0}) {
        World world =
            by_impulses(make_free_boxes({make_rigid({1.0, 1.0, 1.0}, {-1.0, 0.0, 0.0}),
                                         make_rigid({1.0, 1.0, 1.0}, {1.0, 0.0, 0.0}, m1)},
                                        epsilon));
        world.settings.contact_iterations = accuracy.iterations;
        const double u0 = 3.0, u1 = -1.0;
        world.rigid[0].velocity.x() = u0;
        world.rigid[1].velocity.x() = u1;
        ASSERT_FALSE(run(world, 0.5));
        const double sum = u0 + m1 * u1;
        const double v0 = (sum + m1 * epsilon * (u1 - u0)) / (1.0 + m1);
        const double v1 = (sum + epsilon * (u0 - u1)) / (1.0 + m1);
        const double tolerance = accuracy.tolerance;
        EXPECT_NEAR(world.rigid[0].velocity.x(), v0, tolerance) << m1 << " " << epsilon;
        EXPECT_NEAR(world.rigid[1].velocity.x(), v1, tolerance) << m1 << " " << epsilon;
        for (const RigidBox& box : world.rigid) {
          EXPECT_LT(box.velocity.tail<2>().norm(), tolerance) << m1 << " " << epsilon;
          EXPECT_LT(box.angular_velocity.norm(), tolerance) << m1 << " " << epsilon;
        }
      }
    }
  }
}

/// The orientation in which a cube's corner (-1, -1, -1) points along -x.
Eigen::Quaterniond corner_ahead() {
  return Eigen::Quaterniond::FromTwoVectors(Vec3(-1.0, -1.0, -1.0), -Vec3::UnitX());
}

TEST(RigidCollision, ACornerOffTheCentreFollowsTheClosedForm) {
  // A cube flies with a corner ahead against the face x = 1 of a box, at y and z off its centre.
  // The corner's arm lies along the normal, so the cube gets no spin; with I of the box
  //   1/M = 1/m0 + 1/m1 + z^2/I_y + y^2/I_z,   j = (1 + epsilon) u M,
  // the box, hit by -j along x at (1, y, z), turns with omega = I^-1 (r x (-j, 0, 0)).
  const double y = 0.8, z = -1.3, m0 = 2.0, m1 = 7.0, u = 4.0;
  for (const double epsilon : {0.0, 0.5, 1.0}) {
    World world =
        by_impulses(make_free_boxes({make_rigid({2.0, 2.0, 2.0}, {1.5 + std::sqrt(3.0), y, z}, m0),
                                     make_rigid({2.0, 4.0, 5.0}, Vec3::Zero(), m1)},
                                    epsilon));
    world.rigid[0].orientation = corner_ahead();
    world.rigid[0].velocity.x() = -u;
    step_until_contact(world, 0);
    const double inertia_y = m1 / 12.0 * (2.0 * 2.0 + 5.0 * 5.0);
    const double inertia_z = m1 / 12.0 * (2.0 * 2.0 + 4.0 * 4.0);
    const double j =
        (1.0 + epsilon) * u / (1.0 / m0 + 1.0 / m1 + z * z / inertia_y + y * y / inertia_z);
    const RigidBox& cube = world.rigid[0];
    const RigidBox& box = world.rigid[1];
    EXPECT_LT((cube.velocity - Vec3(j / m0 - u, 0.0, 0.0)).norm(), 1e-13);  // rounding
    EXPECT_LT(cube.angular_velocity.norm(), 1e-13);
    EXPECT_LT((box.velocity - Vec3(-j / m1, 0.0, 0.0)).norm(), 1e-13);
    const Vec3 omega(0.0, -j * z / inertia_y, j * y / inertia_z);
    EXPECT_LT((box.angular_velocity - omega).norm(), 1e-13);
    EXPECT_GT(omega.norm(), 0.1);
  }
}

TEST(RigidCollision, KeepsMomentumThroughTumblingCollisions) {
  World world = make_free_boxes({}, 0.5);
  for (int i = 0; i < 9; ++i) {
    RigidBox box =
        make_rigid({1.0 + 0.1 * i, 1.0, 2.0}, {1.7 * (i % 3), 1.7 * (i / 3), 0.3 * i}, 1.0 + i);
    box.rho_g = 0.0;
    box.surface = {0.5, 0.6};
    box.velocity = {-2.0 * (i % 3 - 1), -2.0 * (i / 3), 0.1 * i};
    box.angular_velocity = {0.5 * i, 1.0, -0.3 * i};
    world.rigid.push_back(box);
  }
  const Momentum start = momentum(world);
  std::size_t contacts = 0;
  Stepper stepper(world);
  for (int i = 0; i < 180; ++i) {
    ASSERT_FALSE(stepper.step(world));
    contacts += stepper.contacts().size();
    ASSERT_LT((momentum(world).linear - start.linear).norm(), 1e-12);  // of 30 kg m/s
  }
  EXPECT_GT(contacts, 20U);
}

/// The most that a step has added to the energy of two cubes, whose free motion keeps it exactly,
/// and which meet at random, turning: of what it was before the step.
double greatest_gain(ContactMethod method, double restitution) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  int met = 0;
  double worst = 0.0;
  constexpr int trials = 600;
  for (int trial = 0; trial < trials; ++trial) {
    World world = make_free_boxes({make_rigid({1.0, 1.0, 1.0}, {-1.2, 0.0, 0.0}),
                                   make_rigid({1.0, 1.0, 1.0}, {1.2, 0.0, 0.0}, 3.0)},
                                  0.0);
    world.settings.contact = method;
    for (RigidBox& box : world.rigid) {
      box.surface = {restitution, trial % 3 * 0.5};
      box.position += 0.3 * vector();
      box.orientation =
          Eigen::Quaterniond(Eigen::AngleAxisd(3.0 * unit(random), vector().normalized()));
      box.velocity = Vec3(box.position.x() < 0.0 ? 4.0 : -4.0, 0.0, 0.0) + vector();
      box.angular_velocity = 6.0 * vector();
    }
    Stepper stepper(world);
    double before = energy(world).kinetic;
    bool touched = false;
    for (int step = 0; step < 60; ++step) {
      EXPECT_FALSE(stepper.step(world));
      touched |= !stepper.contacts().empty();
      const double after = energy(world).kinetic;
      worst = std::max(worst, after / before - 1.0);
      before = after;
    }
    met += touched ? 1 : 0;
  }
  EXPECT_GT(met, trials / 2);
  return worst;
}

TEST(RigidCollision, NoStepAddsEnergyWhateverTheSurfaces) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    EXPECT_LT(greatest_gain(ContactMethod::impulses, restitution), 1e-12) << restitution;
    // Swept boxes that are nearer than their skins are moved apart, which is work.
    EXPECT_LT(greatest_gain(ContactMethod::swept, restitution), 1e-3) << restitution;
  }
  EXPECT_LT(greatest_gain(ContactMethod::swept, 1.0), 1e-12) << "an island that returns energy";
}

}  // namespace
}  // namespace pneuma::sim
