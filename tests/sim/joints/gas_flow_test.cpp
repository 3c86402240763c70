// Gas by keys, through leaks and through valves.
#include "sim/joints/gas_flow.h"

#include <gtest/gtest.h>

#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"
#include "sim/joints/orifice.h"
#include "sim/rigid/given_motion.h"
#include "tests/sim/joints/gas_worlds.h"
#include "tests/support/count_allocations.h"

namespace pneuma::sim {
namespace {

TEST(Orifice, IsTheIsentropicJetByMachNumbers) {
  for (const double ratio : {0.0, 0.1, 0.5, 0.53, 0.7, 0.9, 0.998, 0.9995, 1.0 - 1e-9}) {
    const double expected = flux_by_mach_number(2e5, 300.0, ratio * 2e5);
    EXPECT_NEAR(orifice_flux(2e5, 300.0, ratio * 2e5) / expected, 1.0, 1e-9) << ratio;
  }
  EXPECT_EQ(orifice_flux(2e5, 300.0, 2e5), 0.0);
  EXPECT_EQ(orifice_flux(0.0, 300.0, 0.0), 0.0);
}

TEST(Orifice, ChokedAirHasItsKnownFluxAndSlowAirThatOfAnIncompressibleFluid) {
  // 0.0404 kg sqrt(K) / (N s) for air (Shapiro 1953, chapter 4); of the constants three digits.
  EXPECT_NEAR(0.0289644 * orifice_flux(1e5, 288.0, 0.0) / (1e5 / std::sqrt(288.0)), 0.0404, 5e-5);
  // rho sqrt(2 dp / rho), which is off by about 3 dp / (4 g p).
  const double rho = 0.0289644 * 1e5 / (8.314472 * 288.0), difference = 500.0;
  EXPECT_NEAR(
      0.0289644 * orifice_flux(1e5, 288.0, 1e5 - difference) / std::sqrt(2.0 * rho * difference),
      1.0, 0.005);
}

/// n of a leaking tank of constant volume after a time, by a million steps of the midpoint rule.
struct Tank {
  double n, strength;  // mol; nRT at the volume, J
};
Tank emptied(const SoftBody& body, double area, double seconds) {
  const double v = volume_of(body), g = body.material.gas_exponent;
  const double outside_t = body.material.temperature;
  Tank tank{body.material.n, body.material.n * 8.314472 * outside_t};
  const auto rate = [&](const Tank& t) {
    const double inside = t.strength / v, own = t.strength / (t.n * 8.314472);
    const bool leaves = inside > air_pressure;
    const double from = leaves ? own : outside_t;
    const double moles = 0.61 * area *
                         (leaves ? -flux_by_mach_number(inside, from, air_pressure)
                                 : flux_by_mach_number(air_pressure, from, inside));
    return Tank{moles, g * 8.314472 * from * moles};
  };
  const int steps = 1'000'000;
  const double h = seconds / steps;
  for (int i = 0; i < steps; ++i) {
    const Tank start = rate(tank);
    const Tank middle =
        rate({tank.n + 0.5 * h * start.n, tank.strength + 0.5 * h * start.strength});
    tank = {tank.n + h * middle.n, tank.strength + h * middle.strength};
  }
  return tank;
}

TEST(GasFlow, ALeakFollowsItsOwnEquation) {
  struct Case {
    double pressure, exponent, seconds;
  };
  // Choked, then slower and slower; with and without heat; from outside to inside.
  for (const Case& of :
       {Case{3.0, 1.0, 1.0}, {3.0, 1.0, 4.5}, {3.0, 1.4, 3.0}, {0.3, 1.0, 2.0}, {0.3, 1.4, 1.0}}) {
    World world = make_free_world(make_ball(0.5, of.pressure, true));
    world.soft[0].material.gas_exponent = of.exponent;
    give_leak(world.soft[0], 0.002);
    const Tank expected = emptied(world.soft[0], 0.002, of.seconds);
    ASSERT_FALSE(run(world, of.seconds));
    const SoftMaterial& material = world.soft[0].material;
    EXPECT_NEAR(material.n / expected.n, 1.0, 1e-7) << of.pressure << ' ' << of.exponent;
    EXPECT_NEAR(gas_strength(material) / expected.strength, 1.0, 1e-7) << of.exponent;
  }
}

TEST(GasFlow, ALeakEndsAtThePressureOutside) {
  for (const double exponent : {1.0, 1.4}) {
    World world = make_free_world(make_ball(0.5, 1.5, true));
    world.soft[0].material.gas_exponent = exponent;
    give_leak(world.soft[0], 0.05);
    ASSERT_FALSE(run(world, 2.0));
    EXPECT_NEAR(pressure_of(world.soft[0]) / air_pressure, 1.0, 1e-10);
  }
}

/// What is flat holds no gas: nothing is left that its volume, about zero, could press together.
TEST(GasFlow, ABodyThatLeaksIntoVacuumEmptiesAndLiesFlat) {
  SoftBody ball = make_ball(0.5, 1e-4, false, {0.0, 0.0, 0.6});
  ball.material.ambient_pressure = 0.0;
  ball.material.k = 20.0;
  give_leak(ball, 0.02);
  World world = make_free_world(std::move(ball));
  world.settings.gravity = {0.0, 0.0, -9.81};
  world.settings.ground = ContactMaterial{};
  const auto divergence = run(world, 8.0);
  ASSERT_FALSE(divergence) << divergence->what;
  EXPECT_EQ(world.soft[0].material.n, 0.0);
  EXPECT_LT(std::abs(volume_of(world.soft[0])), 1e-3);
}

World make_joined(double one, double other, bool stiff, double exponent = 1.0) {
  World world = make_free_world(make_ball(0.5, one, stiff));
  world.soft.push_back(make_ball(0.7, other, stiff, {4.0, 0.0, 0.0}));
  for (SoftBody& body : world.soft) body.material.gas_exponent = exponent;
  world.valves = {{0, 1, {.area = 0.01}}};
  return world;
}

TEST(GasFlow, AValveEvensThePressuresAndKeepsTheGas) {
  World world = make_joined(3.0, 1.2, true);
  const double n = world.soft[0].material.n + world.soft[1].material.n;
  const double v = volume_of(world.soft[0]) + volume_of(world.soft[1]);
  ASSERT_FALSE(run(world, 4.0));
  const SoftMaterial& first = world.soft[0].material;
  const SoftMaterial& second = world.soft[1].material;
  EXPECT_NEAR((first.n + second.n) / n, 1.0, 1e-14);
  const double even = n * 8.314472 * first.temperature / v;
  EXPECT_NEAR(pressure_of(world.soft[0]) / even, 1.0, 1e-11);
  EXPECT_NEAR(pressure_of(world.soft[1]) / even, 1.0, 1e-11);
}

TEST(GasFlow, AValveWithoutHeatKeepsTheInnerEnergy) {
  World world = make_joined(3.0, 1.2, true, 1.4);
  const auto energy = [&] {  // PV / (g - 1)
    double sum = 0.0;
    for (const SoftBody& body : world.soft) sum += pressure_of(body) * volume_of(body) / 0.4;
    return sum;
  };
  const double before = energy();
  ASSERT_FALSE(run(world, 4.0));
  EXPECT_NEAR(energy() / before, 1.0, 1e-13);
  EXPECT_NEAR(pressure_of(world.soft[0]) / pressure_of(world.soft[1]), 1.0, 1e-11);
  // What lets gas go has cooled, what gets it is warmer.
  const auto temperature = [&](int i) {
    const SoftBody& body = world.soft[at(i)];
    return pressure_of(body) * volume_of(body) / (body.material.n * 8.314472);
  };
  EXPECT_LT(temperature(0), 260.0);
  EXPECT_GT(temperature(1), 310.0);
}

TEST(GasFlow, SoftBodiesComeToOnePressureUnderEveryIntegrator) {
  for (const Integrator integrator : all_integrators) {
    World world = make_joined(1.3, 1.0, false);
    world.settings.integrator = integrator;
    world.settings.steps_per_second = 1920;
    world.valves[0].orifice.area = 0.05;
    for (SoftBody& body : world.soft) body.material.rho_g = 0.5;
    const double n = world.soft[0].material.n + world.soft[1].material.n;
    const double volume = volume_of(world.soft[1]);
    const auto divergence = run(world, 1.5);
    ASSERT_FALSE(divergence) << divergence->what;
    EXPECT_NEAR((world.soft[0].material.n + world.soft[1].material.n) / n, 1.0, 1e-13);
    // The bodies still breathe a little.
    EXPECT_NEAR(pressure_of(world.soft[0]) / pressure_of(world.soft[1]), 1.0, 1e-4)
        << static_cast<int>(integrator);
    EXPECT_GT(volume_of(world.soft[1]), 1.05 * volume);
  }
}

SoftBody make_pumped() {
  SoftBody ball = make_ball(0.5, 1.0, false);
  const double n = ball.material.n;
  GasSupply supply;
  supply.n = {{0.1, n, 0.0, 0.0}, {0.3, 1.5 * n, 0.0, 0.0}, {0.4, 1.2 * n, 0.0, 0.0}};
  supply.temperature = {{0.0, 293.15, 0.0, 0.0}, {0.5, 350.0, 0.0, 0.0}};
  ball.supply = std::make_shared<const GasSupply>(supply);
  return ball;
}

TEST(GasFlow, KeysAreFollowedToTheLastBitUnderEveryIntegrator) {
  for (const Integrator integrator : all_integrators) {
    World world = make_free_world(make_pumped());
    world.settings.integrator = integrator;
    world.settings.steps_per_second = 960;
    Stepper stepper(world);
    for (int i = 0; i < 480; ++i) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << divergence->what;
      const GasSupply& keys = *world.soft[0].supply;
      const double time = static_cast<double>(world.steps) * time_step(world.settings);
      ASSERT_EQ(world.soft[0].material.n, value_at(keys.n, true, time).x());
      ASSERT_EQ(world.soft[0].material.temperature, value_at(keys.temperature, true, time).x());
    }
  }
}

double volume_of_pumped(Integrator integrator, ContactMethod contact) {
  World world = make_free_world(make_pumped());
  world.settings.integrator = integrator;
  world.settings.contact = contact;
  world.settings.steps_per_second = 960;
  EXPECT_FALSE(run(world, 0.45));
  return volume_of(world.soft[0]);
}

TEST(GasFlow, MovesABodyAlikeByEveryFormOfContact) {
  for (const Integrator integrator : all_integrators) {
    if (is_implicit(integrator)) continue;  // which is not the same by potential
    const double swept = volume_of_pumped(integrator, ContactMethod::swept);
    const double potential = volume_of_pumped(integrator, ContactMethod::potential);
    EXPECT_NEAR(potential / swept, 1.0, 1e-10) << static_cast<int>(integrator);
  }
}

/// J, by which the energy of an undamped ball changes besides what is booked for its gas.
double unbooked(int steps_per_second) {
  World world = make_free_world(make_pumped());
  undamp(world.soft[0].material);
  world.settings.steps_per_second = steps_per_second;
  const double before = energy(world).total();
  double booked = 0.0;
  Stepper stepper(world);
  for (int i = 0; i < steps_per_second / 2; ++i) {
    EXPECT_FALSE(stepper.step(world));
    booked += stepper.gas_work();
  }
  EXPECT_GT(std::abs(booked), 1000.0);
  return std::abs(energy(world).total() - before - booked);
}

TEST(GasFlow, WhatGasDoesToTheEnergyIsBooked) {
  // The steps themselves are of fourth order and keep the energy of a constant gas.
  const double coarse = unbooked(960), fine = unbooked(1920);
  EXPECT_LT(coarse, 1.0);
  EXPECT_LT(fine, coarse / 8.0);
}

TEST(GasFlow, PumpedGasBringsItsEnthalpyAndGasTakenAwayCools) {
  World world = make_free_world(make_ball(0.5, 1.0, true));
  SoftBody& ball = world.soft[0];
  ball.material.gas_exponent = 1.4;
  const double n = ball.material.n, v = volume_of(ball);
  GasSupply supply;
  supply.n = {{0.0, n, 0.0, 0.0}, {0.5, 2.0 * n, 0.0, 0.0}, {1.0, n, 0.0, 0.0}};
  supply.outside_temperature = 280.0;
  ball.supply = std::make_shared<const GasSupply>(supply);
  ASSERT_FALSE(run(world, 0.5));
  const double full = pressure_of(ball);
  EXPECT_NEAR(full, air_pressure + 1.4 * n * 8.314472 * 280.0 / v, 1e-9 * full);
  ASSERT_FALSE(run(world, 0.5));
  EXPECT_NEAR(pressure_of(ball), full * std::pow(0.5, 1.4), 1e-9 * full);
}

World make_pumped_and_leaking() {
  World world = make_joined(1.2, 1.0, false);
  world.soft[1] = make_pumped();
  for (int v = 0; v < world.soft[1].positions.size(); ++v) world.soft[1].positions[v].x() += 4.0;
  give_leak(world.soft[0], 0.001);
  world.settings.steps_per_second = 960;
  return world;
}

TEST(GasFlow, GoesOnFromASavedStateToTheLastBit) {
  World world = make_pumped_and_leaking();
  ASSERT_FALSE(run(world, 0.15));
  const std::vector<std::uint8_t> saved = save_state(world);
  ASSERT_FALSE(run(world, 0.1));
  World resumed = make_pumped_and_leaking();
  EXPECT_NE(state_hash(resumed), state_hash(world));
  load_state(saved, resumed);
  ASSERT_FALSE(run(resumed, 0.1));
  EXPECT_EQ(state_hash(resumed), state_hash(world));
  EXPECT_EQ(resumed.soft[0].material.n, world.soft[0].material.n);
}

TEST(GasFlow, DoesNotDependOnThreadsAndIsPartOfTheStatesHash) {
  World world = make_pumped_and_leaking();
  EXPECT_EQ(state_hash_after(world, 0.1, 1), state_hash_after(world, 0.1, 3));
  const std::uint64_t before = state_hash(world);
  world.soft[0].material.n *= 1.0 + 1e-15;
  EXPECT_NE(state_hash(world), before);
}

TEST(GasFlow, IsTakenBackWithAStepThatDiverges) {
  World world = make_pumped_and_leaking();
  ASSERT_FALSE(run(world, 0.12));
  world.settings.integrator = Integrator::rk4;
  world.soft[0].velocities[0] = Vec3(1e9, 0.0, 0.0);
  const std::uint64_t before = state_hash(world);
  Stepper stepper(world);
  ASSERT_TRUE(stepper.step(world));
  EXPECT_EQ(state_hash(world), before);
}

TEST(GasFlow, AllocatesNothing) {
  World world = make_pumped_and_leaking();
  Stepper stepper(world);
  for (int i = 0; i < 10; ++i) ASSERT_FALSE(stepper.step(world));
  const long before = allocation_count();
  for (int i = 0; i < 50; ++i) ASSERT_FALSE(stepper.step(world));
  EXPECT_EQ(allocation_count() - before, 0);
}

}  // namespace
}  // namespace pneuma::sim
