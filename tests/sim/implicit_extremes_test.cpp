// What sim/soft/implicit_step.h guarantees, in extreme cases.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/inspect.h"
#include "tests/sim/implicit_integrators.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

struct Extreme {
  std::string name;
  double k = 50.0, n = 10.0, mass = 0.35;
  double noise = 0.0;         // m and m/s, of every coordinate
  double flatness = 1.0;      // times z
  Vec3 speed = Vec3::Zero();  // m/s
  double spin = 0.0;          // rad/s
  int steps_per_second = 60;
};

const std::vector<Extreme> extremes = {
    {.name = "no_springs", .k = 0.0},
    {.name = "no_gas", .n = 0.0},
    {.name = "nothing", .k = 0.0, .n = 0.0},
    {.name = "stiff", .k = 1e8},
    {.name = "full", .n = 1e6},
    {.name = "stiff_and_full", .k = 1e8, .n = 1e6},
    {.name = "light", .mass = 1e-6},
    {.name = "heavy", .mass = 1e3},
    {.name = "displaced", .noise = 1.5},
    {.name = "displaced_and_stiff", .k = 1e8, .n = 1e6, .noise = 1.5},
    {.name = "displaced_without_gas", .k = 1e4, .n = 0.0, .noise = 1.5},
    {.name = "nearly_flat", .flatness = 1e-12},
    {.name = "nearly_flat_and_full", .k = 1e8, .n = 1e6, .flatness = 1e-12},
    {.name = "falling_at_1000_m_per_s", .k = 1e4, .speed = {0, 0, -1000}},
    {.name = "grazing_at_1000_m_per_s", .k = 1e4, .speed = {1000, 0, -10}},
    {.name = "spinning", .k = 1e4, .spin = 500.0},
    {.name = "a_step_a_second", .k = 1e6, .n = 1e4, .noise = 0.5, .steps_per_second = 1},
};

World make_world(const Extreme& extreme, Integrator integrator) {
  SoftBody body = make_body(make_sphere(3.0, 8, 8));
  body.material.k = extreme.k;
  body.material.n = extreme.n;
  body.material.vertex_mass = extreme.mass;
  perturb(body, extreme.noise, 5);
  for (int v = 0; v < body.positions.size(); ++v) {
    body.velocities[v] +=
        extreme.speed + extreme.spin * Vec3::UnitX().cross(Vec3(body.positions[v]));
    body.positions[v].z() *= extreme.flatness;
  }
  for (int v = 0; v < body.positions.size(); ++v) body.positions[v].z() += 5.0;
  World world;
  world.soft.push_back(std::move(body));
  world.settings.integrator = integrator;
  world.settings.steps_per_second = extreme.steps_per_second;
  return world;
}

/// J: all terms of the energy, of which rounding is a share.
double magnitude(const World& world) {
  const Energy e = energy(world);
  return e.kinetic + e.spring + std::abs(e.gas) + std::abs(e.gravity);
}

class ExtremeCase : public testing::TestWithParam<std::tuple<Extreme, Integrator>> {};
INSTANTIATE_TEST_SUITE_P(Extremes, ExtremeCase,
                         testing::Combine(testing::ValuesIn(extremes),
                                          testing::ValuesIn(implicit_integrators)),
                         [](const auto& tested) {
                           return std::get<0>(tested.param).name + "_by_" +
                                  name(std::get<1>(tested.param));
                         });

TEST_P(ExtremeCase, VolumeStaysAboveZeroAndEnergyDoesNotGrow) {
  const auto& [extreme, integrator] = GetParam();
  World world = make_world(extreme, integrator);
  Stepper stepper(world);
  double last = energy(world).total();
  for (int i = 0; i < 120; ++i) {
    ASSERT_FALSE(stepper.step(world)) << i;
    if (extreme.n > 0.0) {
      ASSERT_GT(volume(world.soft[0].mesh->topology, world.soft[0].positions), 0.0) << i;
    }
    const double now = energy(world).total();
    // Rounding: 1e-13 of the terms is allowed to the step itself, as much again to these sums.
    ASSERT_LE(now, last + 3e-13 * magnitude(world)) << i;
    ASSERT_GE(bounds(world).low.z(), 0.0) << i;
    last = now;
  }
}

TEST(ImplicitExtremes, StiffFirmSphereRunsAMinuteAtTheUsualStep) {
  for (const Integrator integrator : implicit_integrators) {
    World world;
    world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 3.2}));
    SoftMaterial& material = world.soft[0].material;
    material.k = 1e6;
    material.n = 1e4;
    material.temperature = 4.4;
    material.vertex_mass = 0.36;
    World by_rk4 = world;
    EXPECT_TRUE(run(by_rk4, 1.0)) << "an explicit integrator must fail at this";
    world.settings.integrator = integrator;
    ASSERT_FALSE(run(world, 60.0)) << name(integrator);
    const Vec3 size = bounds(world).size();
    EXPECT_NEAR(size.minCoeff(), 6.0, 0.1);  // a ball of 6 m, dented where it stands
    EXPECT_NEAR(size.maxCoeff(), 6.0, 0.1);
    EXPECT_LT(energy(world).kinetic, 1e-6);
  }
}

}  // namespace
}  // namespace pneuma::sim
