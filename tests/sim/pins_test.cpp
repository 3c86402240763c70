// Soft bodies with pinned vertices, of which some follow a motion.
#include "sim/soft/pins.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "sim/rigid/given_motion.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

constexpr std::array all_integrators = {
    Integrator::martin, Integrator::symplectic_euler, Integrator::velocity_verlet, Integrator::rk4,
    Integrator::rk8,    Integrator::implicit_euler,   Integrator::sdirk2};

/// Pins what starts above a height, m.
void pin_above(SoftBody& body, double height, const KeyFrames& keys = {}) {
  std::vector<std::uint8_t> is_pinned(at(body.positions.size()));
  for (int v = 0; v < body.positions.size(); ++v) {
    is_pinned[at(v)] = body.positions[v].z() > height ? 1 : 0;
  }
  GivenMotion motion;
  motion.keys = keys;
  motion.position = mean(body.positions);
  auto follows = keys.empty() ? std::vector<std::uint8_t>(is_pinned.size()) : is_pinned;
  body.pins = make_pins(body.positions, is_pinned, std::move(follows), motion);
}

/// A ball that hangs by its upper cap, over a ground that it does not reach.
World make_hanging(const KeyFrames& keys = {}) {
  World world;
  SoftBody ball = make_body(make_icosphere(1.0, 2), {0.0, 0.0, 4.0});
  ball.material.n = 0.02;
  ball.material.k = 40.0;
  ball.material.vertex_mass = 0.02;
  pin_above(ball, 4.7, keys);
  world.settings.steps_per_second = 240;
  world.soft = {ball};
  return world;
}

const KeyFrames turned_and_lifted = {.path = {{0.0, 0.0, 0.0, 0.0}, {0.5, 0.3, 0.0, 1.0}},
                                     .rotation = {{0.0, 0.0, 0.0, 0.0}, {0.5, 0.0, 0.0, 90.0}},
                                     .smooth = true};

TEST(Pins, HoldTheirVerticesToTheLastBitUnderEveryIntegrator) {
  for (const Integrator integrator : all_integrators) {
    for (const Damping damping : {Damping::dashpot, Damping::literal}) {
      World world = make_hanging();
      world.settings.integrator = integrator;
      world.soft[0].material.damping = damping;
      const VertexArray start = world.soft[0].positions;
      const auto divergence = run(world, 0.5);
      ASSERT_FALSE(divergence) << divergence->what;
      int others = 0, moved = 0;
      for (int v = 0; v < start.size(); ++v) {
        if (is_pinned(world.soft[0], v)) {
          EXPECT_EQ(Vec3(world.soft[0].positions[v]), Vec3(start[v]));
          EXPECT_EQ(Vec3(world.soft[0].velocities[v]), Vec3(0.0, 0.0, 0.0));
        } else {
          ++others;
          moved += Vec3(world.soft[0].positions[v]) != Vec3(start[v]) ? 1 : 0;
        }
      }
      EXPECT_LT(others, start.size());
      EXPECT_EQ(moved, others);
    }
  }
}

/// The same equation by hand: Euler-Cromer with the forces of all vertices, then none on some.
VertexArray by_hand(const World& world, double seconds, int steps_per_second) {
  SoftBody body = world.soft[0];
  AccelerationScratch scratch(*body.mesh);
  const SoftAcceleration force(*body.mesh, body.material, world.settings.gravity, scratch);
  VertexArray acceleration(body.positions.size());
  const double h = 1.0 / steps_per_second;
  for (int i = 0; i < std::lround(seconds * steps_per_second); ++i) {
    force(body.positions, body.velocities, acceleration);
    for (int v = 0; v < body.positions.size(); ++v) {
      if (is_pinned(body, v)) continue;
      body.velocities[v] += h * acceleration[v];
      body.positions[v] += h * body.velocities[v];
    }
  }
  return body.positions;
}

double farthest_apart(const VertexArray& a, const VertexArray& b) {
  return std::sqrt((a.rows() - b.rows()).colwise().squaredNorm().maxCoeff());
}

TEST(Pins, LeaveTheOtherVerticesTheirEquationOfMotion) {
  constexpr double seconds = 0.25;
  World start = make_hanging();
  const VertexArray fine = by_hand(start, seconds, 96'000);
  // Extrapolated to a step of zero: its error is of first order.
  VertexArray exact = fine;
  exact.rows() += fine.rows() - by_hand(start, seconds, 48'000).rows();
  for (const Integrator integrator : all_integrators) {
    const auto error = [&](int steps_per_second) {
      World world = start;
      world.settings.integrator = integrator;
      world.settings.steps_per_second = steps_per_second;
      EXPECT_FALSE(run(world, seconds));
      return farthest_apart(world.soft[0].positions, exact);
    };
    const bool is_first_order = integrator == Integrator::martin ||
                                integrator == Integrator::symplectic_euler ||
                                integrator == Integrator::implicit_euler;
    if (integrator == Integrator::rk8) {  // better than what it is compared with
      EXPECT_LT(error(480), 1e-7);
      continue;
    }
    EXPECT_GT(error(480) / error(960), is_first_order ? 1.8 : 3.0) << static_cast<int>(integrator);
    EXPECT_LT(error(960), is_first_order ? 2e-2 : 2e-4) << static_cast<int>(integrator);
  }
}

TEST(Pins, CarryTheWeightOfABodyAtRest) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::implicit_euler}) {
    World world = make_hanging();
    world.settings.integrator = integrator;
    world.soft[0].material.rho_g = 0.2;
    ASSERT_FALSE(run(world, 4.0));
    const SoftBody& body = world.soft[0];
    AccelerationScratch scratch(*body.mesh);
    VertexArray acceleration(body.positions.size());
    SoftAcceleration(*body.mesh, body.material, Vec3::Zero(), scratch)(
        body.positions, body.velocities, acceleration);
    Vec3 on_pins = Vec3::Zero();
    int free = 0;
    for (int v = 0; v < body.positions.size(); ++v) {
      if (is_pinned(body, v)) {
        on_pins += body.material.vertex_mass * acceleration[v];
      } else {
        ++free;
      }
    }
    const double weight = free * body.material.vertex_mass * 9.81;
    EXPECT_LT((on_pins - Vec3(0.0, 0.0, -weight)).norm(), 1e-3 * weight);
  }
}

TEST(Pins, FollowTheirMotionAsOnePieceUnderEveryIntegrator) {
  for (const Integrator integrator : all_integrators) {
    World world = make_hanging(turned_and_lifted);
    world.settings.integrator = integrator;
    const VertexArray start = world.soft[0].positions;
    const Pins& pins = *world.soft[0].pins;
    Stepper stepper(world);
    for (int i = 0; i < 150; ++i) {
      const VertexArray before = world.soft[0].positions;
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->what;
      const Pose pose = pose_at(pins.motion, time(world));
      for (int v = 0; v < start.size(); ++v) {
        if (!is_pinned(world.soft[0], v)) continue;
        const Vec3 place =
            pose.position + pose.orientation * (Vec3(start[v]) - pins.motion.position);
        EXPECT_LT((Vec3(world.soft[0].positions[v]) - place).norm(), 1e-14);
        // What contacts saw during the step.
        const Vec3 moved_by = time_step(world.settings) * Vec3(world.soft[0].velocities[v]);
        EXPECT_LT((moved_by - (place - Vec3(before[v]))).norm(), 1e-14);
      }
    }
    EXPECT_GT(mean(world.soft[0].positions).z(), 4.3);
  }
}

/// A ball falls on one that is pinned at its top, or flies against its side.
TEST(Pins, HoldInContactsAndNothingPassesThrough) {
  for (const Integrator integrator : {Integrator::rk4, Integrator::implicit_euler}) {
    for (const Vec3& from : {Vec3(0.1, 0.05, 6.3), Vec3(2.3, 0.1, 4.2)}) {
      for (const bool moves : {false, true}) {
        World world = make_hanging(moves ? turned_and_lifted : KeyFrames{});
        world.settings.integrator = integrator;
        SoftBody ball = make_body(make_icosphere(1.0, 1), from);
        ball.material.n = 0.02;
        ball.material.k = 60.0;
        ball.material.vertex_mass = 0.05;
        for (int v = 0; v < ball.positions.size(); ++v) {
          ball.velocities[v] = 4.0 * (Vec3(0.0, 0.0, 4.0) - from).normalized();
        }
        world.soft.push_back(ball);
        const VertexArray start = world.soft[0].positions;
        Stepper stepper(world);
        std::size_t contacts = 0;
        for (int i = 0; i < 120; ++i) {
          const auto divergence = stepper.step(world);
          ASSERT_FALSE(divergence) << divergence->what;
          ASSERT_EQ(i % 8 == 0 ? crossings(world).between_bodies : 0, 0) << "after step " << i;
          contacts += stepper.contacts().size();
        }
        EXPECT_GT(contacts, 0u);
        for (int v = 0; v < start.size() && !moves; ++v) {
          if (!is_pinned(world.soft[0], v)) continue;
          EXPECT_EQ(Vec3(world.soft[0].positions[v]), Vec3(start[v]));
        }
      }
    }
  }
}

TEST(Pins, OfAPlateOnABodyHeldAtItsBottomOnTheGround) {
  World world;
  SoftBody ball = make_body(make_icosphere(1.0, 2), {0.0, 0.0, 0.99});
  ball.material.n = 0.1;
  ball.material.k = 60.0;
  ball.material.vertex_mass = 0.02;
  for (int v = 0; v < ball.positions.size(); ++v) ball.positions[v].z() *= -1.0;
  pin_above(ball, -0.3);
  const Pins pins = *ball.pins;
  ball.positions = make_body(make_icosphere(1.0, 2), {0.0, 0.0, 0.99}).positions;
  ball.pins = make_pins(ball.positions, pins.is_pinned, pins.follows, {});
  world.settings.steps_per_second = 240;
  for (const Integrator integrator : {Integrator::rk4, Integrator::sdirk2}) {
    World pressed = world;
    pressed.settings.integrator = integrator;
    pressed.soft = {ball};
    pressed.rigid = {make_rigid({3.0, 3.0, 0.3}, {0.0, 0.0, 2.3}, 1.0)};
    Stepper stepper(pressed);
    for (int i = 0; i < 240; ++i) {
      const auto divergence = stepper.step(pressed);
      ASSERT_FALSE(divergence) << divergence->what;
      ASSERT_EQ(i % 8 == 0 ? crossings(pressed).between_bodies : 0, 0) << "after step " << i;
    }
    for (int v = 0; v < ball.positions.size(); ++v) {
      if (!is_pinned(ball, v)) continue;
      EXPECT_EQ(Vec3(pressed.soft[0].positions[v]), Vec3(ball.positions[v]));
    }
  }
}

}  // namespace
}  // namespace pneuma::sim
