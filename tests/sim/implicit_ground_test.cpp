// Bodies on the ground under the implicit integrators: rest, friction, rebounds.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/inspect.h"
#include "tests/sim/implicit_integrators.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

class ImplicitOnGround : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Both, ImplicitOnGround, testing::ValuesIn(implicit_integrators),
                         [](const auto& tested) { return name(tested.param); });

/// The scene pressure_soft after ten seconds.
Vec3 size_at_rest(Integrator integrator, int steps_per_second) {
  World world;
  world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 4.0}));
  SoftMaterial& material = world.soft[0].material;
  material.k = 10.0;
  material.n = 1.0;
  material.vertex_mass = 0.36;
  world.settings.integrator = integrator;
  world.settings.steps_per_second = steps_per_second;
  EXPECT_FALSE(run(world, 10.0));
  EXPECT_EQ(bounds(world).low.z(), 0.0);
  return bounds(world).size();
}

TEST_P(ImplicitOnGround, RestsOnTheGroundAsByRk4) {
  const Vec3 expected = size_at_rest(Integrator::rk4, 240);
  const auto error = [&](int rate) {
    return (size_at_rest(GetParam(), rate) - expected).norm() / expected.norm();
  };
  // Friction holds the vertices where they came to stand, and so the error of the way there: of
  // first order for both, since contacts are.
  const double coarse = error(60);
  EXPECT_LT(coarse, GetParam() == Integrator::sdirk2 ? 0.01 : 0.03);
  EXPECT_LT(error(240), coarse / 2.0);
}

/// A soft cube of 2 m on a slope with mu = 0.5, whose angle's tangent is `share` of that.
World cube_on_slope(Integrator integrator, double share) {
  World world;
  world.soft.push_back(make_body(make_box({2.0, 2.0, 2.0}, 2), {0.0, 0.0, 1.0}));
  SoftMaterial& material = world.soft[0].material;
  material.k = 5000.0;
  material.n = 0.0;
  world.settings.integrator = integrator;
  const double angle = std::atan(share * 0.5);
  world.settings.gravity = 9.81 * Vec3(std::sin(angle), 0.0, -std::cos(angle));
  return world;
}

TEST_P(ImplicitOnGround, FrictionHoldsBelowItsAngle) {
  World world = cube_on_slope(GetParam(), 0.9);
  ASSERT_FALSE(run(world, 5.0));
  const Vec3 before = mean(world.soft[0].positions);
  ASSERT_FALSE(run(world, 5.0));
  // m: what is left of its swinging. Nothing creeps: sliding at anchor_speed it would be 5e-4.
  EXPECT_LT((mean(world.soft[0].positions) - before).norm(), 5e-5);
}

TEST_P(ImplicitOnGround, FrictionLetsSlideAboveItsAngle) {
  World world = cube_on_slope(GetParam(), 2.0);
  world.soft[0].material.rho_g = 0.0;
  ASSERT_FALSE(run(world, 1.0));
  const double before = mean(world.soft[0].velocities).x();
  ASSERT_FALSE(run(world, 2.0));
  const double angle = std::atan(2.0 * 0.5);
  const double a = 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
  // Friction may be off by friction_bound_change, 5 %, while the ground's forces change; it is half
  // of g here.
  EXPECT_NEAR((mean(world.soft[0].velocities).x() - before) / (2.0 * a), 1.0, 0.05);
}

TEST_P(ImplicitOnGround, ReboundsOfAVertexAreTheGroundsRestitution) {
  // Without springs and gas every vertex is for itself.
  SoftBody body = make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 3.5});
  body.material.k = 0.0;
  body.material.n = 0.0;
  undamp(body.material);
  body.material.surface.restitution = 0.6;
  for (int v = 0; v < body.positions.size(); ++v) body.velocities[v].z() = -5.0;
  World world;
  world.soft.push_back(std::move(body));
  world.settings.gravity.setZero();
  world.settings.integrator = GetParam();
  ASSERT_FALSE(run(world, 2.0));
  for (int v = 0; v < world.soft[0].velocities.size(); ++v) {
    EXPECT_NEAR(world.soft[0].velocities[v].z(), 0.6 * 5.0, 1e-9);
  }
}

}  // namespace
}  // namespace pneuma::sim
