// The dashpots of hinges: what they take, against closed forms, and what they keep.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/mesh/primitives.h"
#include "sim/mesh/rotation.h"
#include "sim/soft/bending.h"
#include "sim/soft/euler_solver.h"
#include "sim/soft/explicit_step.h"
#include "tests/sim/bending/bent_body.h"
#include "tests/sim/implicit_integrators.h"

namespace pneuma::sim {
namespace {

constexpr double tau = 0.02;  // s

/// Of the dashpots alone, N.
VertexArray dashpot_forces(const SoftBody& body) {
  VertexArray both(body.positions.size()), elastic(body.positions.size());
  add_damped_bending_forces(*body.mesh->hinges, body.positions, body.velocities, rigidity, tau, 1,
                            both);
  add_bending_forces(*body.mesh->hinges, body.positions, rigidity, 1, elastic);
  both.rows() -= elastic.rows();
  return both;
}

double power(const SoftBody& body) {
  return dashpot_forces(body).rows().cwiseProduct(body.velocities.rows()).sum();
}

TEST(HingeDamping, OnlyTakesEnergyAndKeepsMomentum) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    for (const TriangleMesh& mesh :
         {make_box({2.0, 1.0, 0.5}, 2), make_icosphere(1.0, 1), make_torus(2.0, 0.7, 7, 6)}) {
      const SoftBody body = bent(mesh, 0.05 * seed, seed);
      const VertexArray force = dashpot_forces(body);
      EXPECT_LT(power(body), 0.0);
      expect_to_push_and_turn_nothing_as_a_whole(force, body);
    }
  }
}

TEST(HingeDamping, LeavesRigidMotionsInPeace) {
  SoftBody body = bent(make_torus(2.0, 0.7, 7, 6), 0.1, 3);
  const VertexArray bending = dashpot_forces(body);
  for (int v = 0; v < body.positions.size(); ++v) {
    body.velocities[v] = Vec3(3.0, -1.0, 2.0) + Vec3(1.0, 2.0, -1.0).cross(Vec3(body.positions[v]));
  }
  ASSERT_GT(bending.rows().norm(), 1.0);
  EXPECT_LT(dashpot_forces(body).rows().norm(), 1e-10 * bending.rows().norm());
}

/// Two triangles that are flat at rest, of the areas 0.5 and 0.4 m^2.
struct OneHinge {
  HingeTable hinges{{{0, 1, 2, 3}}, {1.5}, {{}}, {{0.5, 0.4}}};
  VertexArray positions = VertexArray(4);
  double mass = 0.3;  // kg, per vertex

  OneHinge() {
    positions[1] = Vec3(1.0, 0.0, 0.0);
    positions[2] = Vec3(0.4, 1.0, 0.0);
    positions[3] = Vec3(0.6, -0.8, 0.0);
  }
  double operator()(const VertexArray& x, const VertexArray& v, VertexArray& result) const {
    result.rows().setZero();
    add_damped_bending_forces(hinges, x, v, rigidity, tau, 1, result);
    result.rows() /= mass;
    return 1.0;
  }
};

TEST(HingeDamping, AMotionAboutTheRestAngleDiesAwayAsItSays) {
  OneHinge hinge;
  const Eigen::Matrix<double, 12, 1> root =
      hinge_stiffness_root(hinge.hinges, hinge.positions, rigidity, 0);
  const double squared = root.squaredNorm() / hinge.mass;  // omega^2
  const double rate = 0.5 * tau * squared;
  const double period = 2.0 * std::numbers::pi / std::sqrt(squared - rate * rate);
  ASSERT_GT(squared, 2.0 * rate * rate);
  SoftState state{hinge.positions, VertexArray(4)};
  // Of 1e-4 m: sines of angles, to 1e-8. It starts as exp(-rate t) cos(2 pi t / period) does.
  const double start = 1e-4;
  for (int i = 0; i < 4; ++i) {
    const Vec3 along = start / root.norm() * root.segment<3>(3 * i);
    state.positions[i] += along;
    state.velocities[i] = -rate * along;
  }
  const int periods = 2, steps = 400;
  ExplicitScratch scratch(4, Integrator::rk4);
  VertexArray x(4), v(4);
  for (int i = 0; i < periods * steps; ++i) {
    explicit_step(Integrator::rk4, hinge, period / steps, state, x, v, scratch);
    std::swap(state.positions, x);
    std::swap(state.velocities, v);
  }
  const double left = (state.positions.rows() - hinge.positions.rows()).norm() / start;
  EXPECT_NEAR(-std::log(left) / (periods * period) / rate, 1.0, 1e-3);
}

TEST(HingeDamping, CeasesInATriangleThatGetsFlat) {
  OneHinge hinge;
  VertexArray velocities(4);
  velocities[2] = Vec3::UnitZ();
  const auto drag_at_height = [&](double height) {
    hinge.positions[2] = Vec3(0.4, height, 0.0);
    VertexArray force(4);
    add_damped_bending_forces(hinge.hinges, hinge.positions, velocities, rigidity, tau, 1, force);
    return -force[2].z();
  };
  const double whole = rigidity * 1.5 * tau;  // K tau / height^2, of a height of 1 m
  EXPECT_NEAR(drag_at_height(1.0), whole, 1e-12);
  EXPECT_NEAR(drag_at_height(0.9), whole / 0.81, 1e-12);
  EXPECT_NEAR(drag_at_height(0.85), 0.5 * whole / std::pow(0.85, 2), 1e-12);
  for (const double height : {0.79, 0.1, 1e-6, 0.0}) EXPECT_EQ(drag_at_height(height), 0.0);
}

TEST(HingeDamping, JoinedToTheHingesOfAStepItActsByTheAngleAtItsStart) {
  const SoftBody body = bent(make_icosphere(1.0, 1), 0.1, 5);
  const HingeTable& at_rest = *body.mesh->hinges;
  std::vector<HingeState> start;
  hinge_states(at_rest, body.positions, start);
  HingeTable joined = at_rest;
  join_dashpots(at_rest, start, tau / 1e-3, joined);
  VertexArray turned(body.positions.size()), moved(body.positions.size());
  const Mat3 rotation = rotation_of_degrees({20.0, 70.0, -40.0}).toRotationMatrix();
  const double step = 1e-7;  // s
  for (int v = 0; v < turned.size(); ++v) {
    turned[v] = rotation * Vec3(body.positions[v]);
    moved[v] = Vec3(body.positions[v]) + step * Vec3(body.velocities[v]);
  }
  const auto forces = [&](const HingeTable& hinges, const VertexArray& x) {
    VertexArray force(x.size());
    add_bending_forces(hinges, x, rigidity, 1, force);
    return force;
  };
  // Turned as a whole, it is as if there were none.
  const VertexArray::Rows elastic = forces(at_rest, turned).rows();
  EXPECT_LT((forces(joined, turned).rows() - elastic).norm(), 1e-11 * elastic.norm());
  // Of a short step: as by the velocities, to the second order in the step.
  join_dashpots(at_rest, start, tau / step, joined);
  const VertexArray::Rows dashpots = forces(joined, moved).rows() - forces(at_rest, moved).rows();
  const VertexArray::Rows expected = dashpot_forces(body).rows();
  EXPECT_LT((dashpots - expected).norm(), 1e-5 * expected.norm());
}

/// Bodies of which little but the hinges resists and nothing else damps.
World bending_world(Integrator integrator, int steps_per_second, double damping) {
  SoftBody body = bent(make_icosphere(1.0, 1), 0.0, 1);
  body.material.k = 20.0;
  body.material.n = 0.0;
  body.material.bending = rigidity;
  body.material.bending_damping = damping;
  undamp(body.material);
  perturb(body, 0.015, 7);  // so that f stays 1: it is taken from the start of a step
  World world = make_free_world(body);
  world.settings.integrator = integrator;
  world.settings.steps_per_second = steps_per_second;
  return world;
}

double total_energy(const World& world) {
  const Energy e = energy(world);
  return e.kinetic + e.spring;
}

TEST(HingeDamping, OfImplicitStepsNeverAddsEnergyWhateverTheStep) {
  for (const Integrator integrator : implicit_integrators) {
    for (const ContactMethod contact : {ContactMethod::swept, ContactMethod::potential}) {
      for (const int steps_per_second : {10, 60, 1000}) {
        for (const double damping : {0.003, 0.3, 30.0}) {
          World world = bending_world(integrator, steps_per_second, damping);
          world.settings.contact = contact;
          Stepper stepper(world);
          double before = total_energy(world);
          const double start = before;
          for (int i = 0; i < 20; ++i) {
            ASSERT_FALSE(stepper.step(world));
            const double now = total_energy(world);
            EXPECT_LE(now, before + 1e-12 * start) << name(integrator) << " " << damping;
            before = now;
          }
          EXPECT_LT(before, start);
        }
      }
    }
  }
}

/// Triangles that lose so much of their area that hinges and dashpots fade, within some steps.
TEST(HingeDamping, OfABodyThatIsCrushedNeverAddsEnergyInImplicitSteps) {
  for (const int steps_per_second : {10, 60, 1000}) {
    for (const double damping : {0.003, 0.3, 30.0}) {
      World world = bending_world(Integrator::implicit_euler, steps_per_second, damping);
      SoftBody& body = world.soft[0];
      for (int v = 0; v < body.positions.size(); ++v) {
        body.positions[v].x() = 1.0 + 0.88 * (body.positions[v].x() - 1.0);
        body.velocities[v].x() = -4.0 * (body.positions[v].x() - 1.0);  // further in, at 4 m/s
      }
      Stepper stepper(world);
      double before = total_energy(world);
      const double start = before;
      for (int i = 0; i < 20; ++i) {
        ASSERT_FALSE(stepper.step(world));
        const double now = total_energy(world);
        EXPECT_LE(now, before + 1e-12 * start) << steps_per_second << " " << damping;
        before = now;
      }
    }
  }
}

TEST(HingeDamping, IsTheSameEquationForEveryIntegrator) {
  const auto end = [](Integrator integrator, int steps_per_second, double damping,
                      ContactMethod contact = ContactMethod::swept) {
    World world = bending_world(integrator, steps_per_second, damping);
    world.settings.contact = contact;
    EXPECT_FALSE(run(world, 0.1));
    return VertexArray::Rows(world.soft[0].positions.rows());
  };
  const VertexArray::Rows exact = end(Integrator::rk4, 8000, 0.01);
  ASSERT_GT((end(Integrator::rk4, 8000, 0.0) - exact).norm(), 1e-3);
  for (const ContactMethod contact : {ContactMethod::swept, ContactMethod::potential}) {
    EXPECT_LT((end(Integrator::rk4, 4000, 0.01, contact) - exact).norm(), 1e-6);
    for (const Integrator integrator : implicit_integrators) {
      const double order = integrator == Integrator::sdirk2 ? 2.0 : 1.0;
      const auto error = [&](int steps_per_second) {
        return (end(integrator, steps_per_second, 0.01, contact) - exact).norm();
      };
      // Within 0.15 of the order. Shorter steps come to what minimisers leave over.
      EXPECT_NEAR(std::log2(error(250) / error(500)), order, 0.15) << name(integrator);
    }
  }
}

}  // namespace
}  // namespace pneuma::sim
