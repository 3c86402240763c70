#include "app/world/gas_advice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/world/build_world.h"
#include "app/world/gas_warnings.h"
#include "app/world/scene_warnings.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

std::vector<GasAdvice> advices_on(const std::string& text) {
  return gas_advices(build_world(scenes::parse_scene(text, "test.toml")));
}

/// The number that follows `name` in a text.
std::string number_after(const std::string& text, const std::string& name) {
  const std::size_t begin = text.find(name) + name.size();
  return text.substr(begin, text.find(' ', begin) - begin);
}

TEST(GasAdvice, WhatItSaysKeepsTheSize) {
  const std::string body = "[[body]]\nradius = 2\nn = ";
  const std::vector<GasAdvice> blown_up = advices_on(body + "0.5\n");
  ASSERT_EQ(blown_up.size(), 1u);
  ASSERT_TRUE(blown_up[0].blown_up());
  const std::string warning = gas_warning(blown_up[0]);
  EXPECT_TRUE(warning.starts_with("body 'body1': gas blows it up: ")) << warning;
  const std::string n = number_after(warning, "n of at most ");
  const GasAdvice held = advices_on(body + n + "\nrest = \"equilibrium\"\n").at(0);
  EXPECT_FALSE(held.blown_up()) << warning;
  EXPECT_NEAR(held.settled.value() / held.volume, 1.0, 0.01) << warning;
}

TEST(GasAdvice, SpringsThatBalanceItsGasAndFoldAreToldFromThoseThatHoldIt) {
  const auto ring = [](const std::string& k) {
    return "[[body]]\nshape = \"torus\"\nradius = 6\ntube_radius = 2\nslices = 32\nstacks = 16\n"
           "rest = \"equilibrium\"\nn = 100\nk = " +
           k + "\n";
  };
  const GasAdvice folding = advices_on(ring("6200")).at(0);
  EXPECT_TRUE(folding.held && folding.leaves_shape());
  const std::string warning = shape_warning(folding);
  EXPECT_NE(warning.find("the slightest push folds it"), std::string::npos) << warning;
  const GasAdvice steady = advices_on(ring(number_after(warning, "at least k = "))).at(0);
  EXPECT_TRUE(steady.held && !steady.leaves_shape()) << shape_warning(steady);
  // What is named to those who ask for too much is as good.
  try {
    advices_on(ring("1000"));
    ADD_FAILURE() << "was held";
  } catch (const scenes::SceneError& error) {
    const std::string k = number_after(error.what(), "; from k = ");
    EXPECT_FALSE(advices_on(ring(k)).at(0).leaves_shape()) << error.what();
  }
  // And what is named to those who let it grow.
  const std::string loose =
      "[[body]]\nshape = \"torus\"\nradius = 6\ntube_radius = 2\nslices = 32\n"
      "stacks = 16\nk = 200\nn = ";
  const GasAdvice grown = advices_on(loose + "100\n").at(0);
  ASSERT_TRUE(grown.blown_up());
  const std::string n = number_after(gas_warning(grown), "n of at most ");
  EXPECT_FALSE(advices_on(loose + n + "\nrest = \"equilibrium\"\n").at(0).leaves_shape()) << n;
}

TEST(GasAdvice, WhatSpringsLeaveUnbalancedIsSaid) {
  const auto ball = [](const std::string& slices, const std::string& n) {
    return "[[body]]\nrest = \"equilibrium\"\nk = 5000\nslices = " + slices +
           "\nstacks = " + slices + "\nn = " + n + "\n";
  };
  const GasAdvice fine = advices_on(ball("36", "100")).at(0);
  EXPECT_TRUE(fine.leaves_shape());
  EXPECT_GT(fine.settled.value(), 1.2 * fine.volume);
  const std::string warning = shape_warning(fine);
  EXPECT_NE(warning.find("unbalanced"), std::string::npos) << warning;
  const std::string n = number_after(warning, "n of at most ");
  const GasAdvice held = advices_on(ball("36", n)).at(0);
  EXPECT_NEAR(held.settled.value() / held.volume, 1.0, 0.03) << warning;
  EXPECT_FALSE(advices_on(ball("8", "70")).at(0).leaves_shape());
}

/// m^3, on the ground, as rk4 finds it.
double volume_after(const std::string& text, double seconds) {
  sim::World world = build_world(scenes::parse_scene(text, "test.toml"));
  sim::Stepper stepper(world);
  while (sim::time(world) < seconds) EXPECT_FALSE(stepper.step(world));
  return sim::volume(world.soft[0].mesh->topology, world.soft[0].positions);
}

TEST(GasAdvice, WhatIsTooHeavyForItsGasIsCrushed) {
  const auto ball = [](const std::string& n, const std::string& mass) {
    return "[simulation]\nsteps_per_second = 480\n[[body]]\nposition = [0, 0, 3.1]\nn = " + n +
           "\nmass = " + mass + "\n";
  };
  const GasAdvice heavy = advices_on(ball("0.2", "116")).at(0);
  ASSERT_TRUE(heavy.crushed());
  const std::string warning = weight_warning(heavy);
  const std::string mass = number_after(warning, "mass of at most ");
  EXPECT_FALSE(advices_on(ball("0.2", mass)).at(0).crushed()) << warning;
  EXPECT_LT(volume_after(ball("0.2", "116"), 4.0), 0.6 * heavy.volume);
  EXPECT_GT(volume_after(ball("0.2", mass), 4.0), 0.75 * heavy.volume) << warning;
}

TEST(GasAdvice, TooHeavyBodiesAreCarriedByTheSpringsAndGasThatItNames) {
  const auto ball = [](const std::string& springs_and_gas) {
    return "[simulation]\nsteps_per_second = 960\n[[body]]\nposition = [0, 0, 3.1]\n"
           "density = 300\nthickness = 0.02\n" +
           springs_and_gas;
  };
  for (const std::string how :
       {"k = 50\ninflation = 1.1\n", "k = 50\ngauge_pressure = 40\n", "k = 50\nn = 1.8\n"}) {
    const GasAdvice heavy = advices_on(ball(how)).at(0);
    ASSERT_TRUE(heavy.crushed());
    const std::string warning = weight_warning(heavy);
    const std::string k = number_after(warning, "k = ");
    const std::string gas =
        how.find("inflation") != std::string::npos ? "inflation = 1.1\n"
        : how.find("\nn = ") != std::string::npos
            ? "n = " + number_after(warning, "the gas, n = ") + "\n"
            : "gauge_pressure = " + number_after(warning, "gauge_pressure = ") + "\n";
    const std::string carried = ball("k = " + k + "\n" + gas);
    EXPECT_FALSE(advices_on(carried).at(0).crushed()) << warning;
    EXPECT_GT(volume_after(carried, 4.0), 0.75 * heavy.volume) << warning;
  }
}

TEST(GasAdvice, WhatCarriesABodyKeepsItsShapeToo) {
  const auto ball = [](const std::string& k, const std::string& n, const std::string& bending) {
    return "[[body]]\nposition = [0, 0, 9]\nradius = 2\nstacks = 36\nslices = 36\nmass = 500\n"
           "rest = \"equilibrium\"\nk = " +
           k + "\nn = " + n + "\nbending = " + bending + "\n";
  };
  const GasAdvice heavy = advices_on(ball("50", "0.5", "2")).at(0);
  ASSERT_TRUE(heavy.crushed() && heavy.leaves_shape());
  const std::string warning = weight_warning(heavy);
  const std::string bending = number_after(warning, "bending = ");
  const GasAdvice carried =
      advices_on(ball(number_after(warning, ", k = "), number_after(warning, "the gas, n = "),
                      bending.substr(0, bending.find(','))))
          .at(0);
  EXPECT_FALSE(carried.crushed()) << warning;
  EXPECT_FALSE(carried.leaves_shape()) << warning;
}

TEST(GasAdvice, BesideAnAmbientPressureTooHeavyBodiesAreCarriedByTheGasThatItNames) {
  const auto ball = [](const std::string& gas) {
    return "simulation.ambient_pressure = 500\nsimulation.steps_per_second = 960\n"
           "[[body]]\nposition = [0, 0, 3.1]\ndensity = 300\nthickness = 0.1\nk = 2e4\n" +
           gas;
  };
  const GasAdvice heavy = advices_on(ball("inflation = 1.01\n")).at(0);
  ASSERT_TRUE(heavy.crushed());
  const std::string warning = weight_warning(heavy);
  EXPECT_EQ(warning.find("times as strong"), std::string::npos) << warning;
  const std::string carried =
      ball("gauge_pressure = " + number_after(warning, "gauge_pressure = ") + "\n");
  EXPECT_FALSE(advices_on(carried).at(0).crushed()) << warning;
  EXPECT_GT(volume_after(carried, 4.0), 0.75 * heavy.volume) << warning;
}

TEST(GasAdvice, WhatTheAmbientPressureCrushesIsNotCalledTooHeavy) {
  for (const std::string settings : {"ambient_pressure = 2000", "ambient_pressure = 101325",
                                     "ambient_pressure = 101325\nsimulation.gravity = [0, 0, 0]"}) {
    const auto ball = [&](const std::string& gas) {
      return "simulation.steps_per_second = 3840\nsimulation." + settings +
             "\n[[body]]\nposition = [0, 0, 3.1]\nmass = 5\nk = 400\n" + gas;
    };
    const GasAdvice crushed = advices_on(ball("n = 1\n")).at(0);
    ASSERT_TRUE(crushed.crushed());
    const std::string warning = weight_warning(crushed);
    EXPECT_EQ(warning.find("too heavy"), std::string::npos) << warning;
    EXPECT_NE(warning.find("Pa from outside"), std::string::npos) << warning;
    const std::string gas = "gauge_pressure = " + number_after(warning, "gauge_pressure = ") + "\n";
    const GasAdvice held = advices_on(ball(gas)).at(0);
    EXPECT_FALSE(held.crushed() || held.bursts()) << warning;
    EXPECT_GT(volume_after(ball(gas), 1.0), 0.75 * crushed.volume) << warning;
  }
}

TEST(GasAdvice, WhatStartsFarFromRestInAirBursts) {
  const auto ball = [](const std::string& gas) {
    return "simulation.ambient_pressure = 101325\nsimulation.steps_per_second = 3840\n"
           "simulation.gravity = [0, 0, 0]\n[[body]]\nposition = [0, 0, 9]\nradius = 1\nmass = 1\n"
           "k = 40\nrho_g = 0\n" +
           gas;
  };
  const auto speed = [&](const std::string& gas) {
    sim::World world = build_world(scenes::parse_scene(ball(gas), "test.toml"));
    sim::Stepper stepper(world);
    double kinetic = 0.0;
    while (sim::time(world) < 0.02) {
      EXPECT_FALSE(stepper.step(world));
      kinetic = std::max(kinetic, sim::energy(world).kinetic);
    }
    return std::sqrt(2.0 * kinetic);  // of 1 kg
  };
  const GasAdvice advice = advices_on(ball("inflation = 1.1\n")).at(0);
  ASSERT_TRUE(advice.bursts());
  const std::string warning = start_warning(advice);
  const double told = std::stod(number_after(warning, "kg at "));
  EXPECT_NEAR(speed("inflation = 1.1\n"), told, 0.1 * told) << warning;
  const std::string quiet = "gauge_pressure = " + number_after(warning, "gauge_pressure = ") + "\n";
  EXPECT_FALSE(advices_on(ball(quiet)).at(0).bursts()) << warning;
  EXPECT_LT(speed(quiet), 0.01 * told) << warning;
  EXPECT_FALSE(advices_on("[[body]]\nposition = [0, 0, 9]\ninflation = 1.9\n").at(0).bursts());
}

TEST(GasAdvice, SpringsWithoutGasAreLimpOrHold) {
  const auto ball = [](const std::string& keys) {
    return "[simulation]\nsteps_per_second = 1920\n[[body]]\nposition = [0, 0, 3.1]\nn = 0\n" +
           keys;
  };
  for (const std::string shape : {"", "shape = \"icosphere\"\nvertex_mass = 0.1\n"}) {
    const GasAdvice limp = advices_on(ball(shape + "k = 100\n")).at(0);
    ASSERT_TRUE(limp.crushed()) << shape;
    EXPECT_LT(volume_after(ball(shape + "k = 100\n"), 4.0), 0.4 * limp.volume) << shape;
    const std::string warning = weight_warning(limp);
    EXPECT_NE(warning.find("without gas"), std::string::npos) << warning;

    const std::string stiff = shape + "k = 8000\nk_max = 2e4\n";
    EXPECT_FALSE(advices_on(ball(stiff)).at(0).crushed()) << shape;
    EXPECT_GT(volume_after(ball(stiff), 4.0), 0.9 * limp.volume) << shape;
  }
}

TEST(GasAdvice, SpringsWithoutGasAreLimpOnlyUnderWeightAndWithoutHinges) {
  const auto crushed = [](const std::string& text) { return advices_on(text).at(0).crushed(); };
  const std::string ball = "[[body]]\nn = 0\n";
  EXPECT_TRUE(crushed(ball));
  EXPECT_FALSE(crushed("simulation.gravity = [0, 0, 0]\n" + ball));
  EXPECT_FALSE(crushed("ground.present = false\n" + ball));
  EXPECT_FALSE(crushed(ball + "bending = 10\n"));
  EXPECT_FALSE(crushed(ball + "pinned = [[-9, -9, 1, 9, 9, 9]]\n"));
  EXPECT_FALSE(
      crushed("[[body]]\nname = \"a\"\nn = 0\n[[body]]\nname = \"b\"\nposition = [9, 0, 0]\n"
              "[[valve]]\nfrom = \"b\"\nto = \"a\"\n"));
}

TEST(GasAdvice, WhatHangsIsNotPressed) {
  const auto crushed = [](const std::string& pinned) {
    return advices_on(
               "[[body]]\nposition = [0, 0, 6]\nradius = 1.5\nk = 60\nmass = 20\n"
               "gauge_pressure = 3\n" +
               pinned)
        .at(0)
        .crushed();
  };
  EXPECT_TRUE(crushed(""));
  EXPECT_TRUE(crushed("pinned = [[-9, -9, 4, 9, 9, 4.8]]\n"));
  EXPECT_FALSE(crushed("pinned = [[-9, -9, 7.2, 9, 9, 8]]\n"));
  EXPECT_FALSE(crushed("pinned = [[1.2, -9, 4, 9, 9, 8], [-9, -9, 4, -1.2, 9, 8]]\n")) << "sides";
}

TEST(SceneWarnings, SayWhereAnInflationIsNotMet) {
  // A polyhedron grows without stretching (Bleecker 1996, "Volume increasing isometric deformations
  // of convex polyhedra").
  const auto warning = [](const std::string& inflation) -> std::string {
    const scenes::Scene scene = scenes::parse_scene(
        "simulation.gravity = [0, 0, 0]\n[[body]]\nname = \"bar\"\nshape = \"box\"\n"
        "size = [4, 1.5, 1.5]\ndivisions = 6\nmass = 2\nk = 100\ninflation = " +
            inflation + "\n",
        "test.toml");
    const sim::World world = build_world(scene);
    const auto warnings = scene_warnings(scene, world, {}, gas_advices(world));
    return warnings.empty() ? "" : warnings.at(0);
  };
  EXPECT_NE(warning("1.05").find("'bar': inflation = 1.05 comes to 1.0"), std::string::npos)
      << warning("1.05");
  EXPECT_EQ(warning("1.5"), "");
}

TEST(GasAdvice, IsOfTheMostGasThatKeysGive) {
  const auto advice = [](const std::string& keys) {
    return advices_on("[[body]]\n" + keys + "\n").at(0);
  };
  const GasAdvice constant = advice("n = 10"),
                  fed = advice("supply.n = [[0, 0], [0.5, 10], [1, 2]]");
  EXPECT_TRUE(fed.blown_up());
  EXPECT_EQ(fed.settled, constant.settled);
  EXPECT_EQ(fed.filled_at, 0.5);
  EXPECT_FALSE(fed.crushed());
  const std::string warning = gas_warning(fed);
  EXPECT_NE(warning.find("with its gas of 0.5 s, 10 mol at 293.15 K"), std::string::npos)
      << warning;
  // What keys fill is meant to grow: of 1 mol it does to 2.5 times its volume.
  const GasAdvice swells = advice("supply.n = [[0, 0.05], [2, 1]]"), sudden = advice("n = 1");
  EXPECT_EQ(swells.filled_at, 2.0);
  EXPECT_EQ(swells.settled, sudden.settled);
  EXPECT_TRUE(sudden.blown_up());
  EXPECT_FALSE(swells.blown_up()) << volumes_text(swells);
  EXPECT_EQ(advice("n = 1\nsupply.temperature = [[0, 300], [2, 600]]").settled,
            advice("n = 2\ntemperature = 300").settled);
  // Of what is pumped in, a leak lets some out again.
  EXPECT_FALSE(advice("supply.n = [[0, 0.01], [9, 10]]\nleak.area = 0.1").filled_at);
}

TEST(GasAdvice, IsForEveryMeshAndMaterialOnce) {
  EXPECT_EQ(advices_on("[[body]]\ncopies = [2, 1, 1]\nsupply.n = [[0, 1]]\n").size(), 1u);
  EXPECT_EQ(advices_on("[[body]]\ncopies = [2, 2, 1]\n[[body]]\n[[body]]\nn = 1\n").size(), 2u);
  EXPECT_TRUE(advices_on("[[body]]\nkind = \"rigid\"\n").empty());
}

TEST(GasAdvice, IsLeftOutWhereItTakesLong) {
  const sim::World world =
      build_world(scenes::parse_scene("[[body]]\n[[body]]\nn = 1\n[[body]]\nn = 0\n", "x.toml"));
  const int vertices = world.soft[0].mesh->topology.vertex_count();
  const auto advices = gas_advices(world, 2 * vertices - 1);
  EXPECT_FALSE(advices.at(0).left_out);
  EXPECT_TRUE(advices.at(1).left_out);
  EXPECT_FALSE(advices.at(1).blown_up());
  EXPECT_NE(volumes_text(advices[1]).find("not predicted"), std::string::npos);
  EXPECT_FALSE(advices.at(2).left_out) << "without gas there is nothing to predict";
}

TEST(GasAdvice, HasWordsForBodiesThatNothingHolds) {
  const GasAdvice free = advices_on("[[body]]\nk = 0\n").at(0);
  EXPECT_TRUE(free.blown_up());
  EXPECT_NE(volumes_text(free).find("for ever"), std::string::npos) << volumes_text(free);
  EXPECT_NE(gas_warning(free).find("k above 0"), std::string::npos) << gas_warning(free);
  // A box's faces are flat: springs within them balance no pressure.
  const GasAdvice flat = advices_on("[[body]]\nshape = \"box\"\n").at(0);
  EXPECT_TRUE(flat.blown_up());
  EXPECT_FALSE(flat.max_held.has_value());
  EXPECT_NE(gas_warning(flat).find("inflation = 1.5"), std::string::npos) << gas_warning(flat);
}

}  // namespace
}  // namespace pneuma::app
