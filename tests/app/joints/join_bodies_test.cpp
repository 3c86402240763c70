// Valves and springs of a scene in its world, and motions that turn too fast.
#include "app/joints/join_bodies.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/check/run_statistics.h"
#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "sim/joints/body_springs.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

sim::World world_of(const std::string& text) {
  return build_world(scenes::parse_scene(text, "joined.toml"));
}

std::string refusal(const std::string& text) {
  try {
    world_of(text);
  } catch (const scenes::SceneError& error) {
    return error.what();
  }
  return {};
}

void expect_in(const std::string& text, std::initializer_list<const char*> parts) {
  EXPECT_NE(text, "");
  for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
}

const std::string balls =
    "[[body]]\nname = \"a\"\nradius = 1\nposition = [0, 0, 3]\ncopies = [2, 1, 1]\n"
    "spacing = [5, 0, 0]\n"
    "[[body]]\nname = \"b\"\nradius = 1\nposition = [2, 4, 3]\n"
    "[[body]]\nname = \"cube\"\nkind = \"rigid\"\nposition = [0, 9, 9]\n";

TEST(JoinBodies, PutsAValveBetweenTwoBodies) {
  const sim::World world = world_of(balls + "[[valve]]\nfrom = \"a.2\"\nto = \"b\"\narea = 0.5\n");
  ASSERT_EQ(world.valves.size(), 1u);
  EXPECT_EQ(world.valves[0].first, 1);
  EXPECT_EQ(world.valves[0].second, 2);
  EXPECT_EQ(world.valves[0].orifice.area, 0.5);
}

TEST(JoinBodies, FixesASpringWhereItIsToldOrWhereBodiesAreNearest) {
  const sim::World world =
      world_of(balls + "[[spring]]\nfrom = \"a.1\"\nto = \"a.2\"\n" +
               "[[spring]]\nfrom = \"a.1\"\nto = \"b\"\nfrom_point = [0, 0, 9]\n"
               "to_region = [[-9, -9, 3.5, 9, 9, 9]]\nrest_length = 2\n");
  ASSERT_EQ(world.springs.size(), 2u);
  const auto place = [&](const sim::SpringEnd& end) -> sim::Vec3 {
    return sim::middle(world.soft[sim::at(end.body)].positions, end.vertices);
  };
  EXPECT_LT((place(world.springs[0].first) - sim::Vec3(1.0, 0.0, 3.0)).norm(), 0.2);
  EXPECT_LT((place(world.springs[0].second) - sim::Vec3(4.0, 0.0, 3.0)).norm(), 0.2);
  EXPECT_NEAR(world.springs[0].rest_length, 3.0, 0.1);
  EXPECT_LT((place(world.springs[1].first) - sim::Vec3(0.0, 0.0, 4.0)).norm(), 1e-9);
  EXPECT_GT(world.springs[1].second.vertices.size(), 5u);
  EXPECT_GT(place(world.springs[1].second).z(), 3.5);
  EXPECT_EQ(world.springs[1].rest_length, 2.0);
}

TEST(JoinBodies, RefusesWhatCannotBeJoined) {
  const std::string still =
      "[[body]]\nname = \"s\"\nkind = \"static\"\nshape = \"sphere\"\n"
      "position = [0, -9, 5]\n";
  expect_in(refusal(balls + "[[valve]]\nfrom = \"a\"\nto = \"b\"\n"),
            {"joined.toml:16:8", "valve 1", "names no body that has gas", "a.1, a.2, b"});
  expect_in(refusal(balls + "[[valve]]\nfrom = \"b\"\nto = \"cube\"\n"), {"is a box", "no gas"});
  expect_in(refusal(balls + "[[spring]]\nfrom = \"b\"\nto = \"cube\"\nk = 1\n"),
            {"is a box", "no vertices", "icosphere"});
  expect_in(refusal(balls + "[[valve]]\nfrom = \"b\"\nto = \"b\"\n"), {"the same body"});
  expect_in(refusal(balls + still + "[[valve]]\nfrom = \"b\"\nto = \"s\"\n"), {"has no gas"});
  expect_in(refusal(balls + "[[body]]\nname = \"g\"\ngas_exponent = 1.4\nposition = [0, -9, 5]\n"
                            "[[valve]]\nfrom = \"b\"\nto = \"g\"\n"),
            {"gas_exponent = 1", "1.4"});
  expect_in(refusal(balls + "[[spring]]\nfrom = \"b\"\nto = \"a.1\"\n"
                            "from_region = [[50, 0, 0, 60, 1, 1]]\n"),
            {"spring 1", "from_region: no vertex of 'b'"});
}

TEST(JoinBodies, SaysAllErrorsOfASceneAtOnce) {
  const std::string region = "[[spring]]\nfrom = \"b\"\nto = \"a.1\"\nfrom_region = ";
  expect_in(
      refusal(balls + region + "[[50, 0, 0, 60, 1, 1]]\n" + region + "[[70, 0, 0, 80, 1, 1]]\n"),
      {"joined.toml:15:1: spring 1", "joined.toml:19:1: spring 2"});
  expect_in(refusal(balls + "[[valve]]\nfrom = \"c\"\nto = \"a.3\"\n"
                            "[[spring]]\nfrom = \"a.0\"\nto = \"cube\"\n"
                            "[[body]]\nname = \"b\"\n"),
            {"joined.toml:16:8: valve 1: from", "joined.toml:17:6: valve 1: to",
             "joined.toml:19:8: spring 1", "joined.toml:20:6: spring 1", "two bodies are called"});
}

TEST(JoinBodies, BlamesNoJointForANameThatWasRefused) {
  const std::string text =
      refusal("[[body]]\nname = \"5\"\n[[body]]\n[[valve]]\nfrom = \"5\"\nto = \"body2\"\n");
  expect_in(text, {"joined.toml:2:8"});
  EXPECT_EQ(text.find("valve"), std::string::npos) << text;
}

TEST(CheckTurns, RefusesATurnThatAStepWouldTakeTheOtherWay) {
  const auto turning = [](const std::string& keys) {
    return "simulation.steps_per_second = 60\n[[body]]\n[[body]]\nname = \"fan\"\nkind = "
           "\"moved\"\nposition = [9, 0, 9]\n" +
           keys;
  };
  expect_in(refusal(turning("motion.rotation = [[0, 0, 0, 0], [0.1, 0, 0, 360], [0.11, 0, 0, "
                            "90]]\nmotion.smooth = false\n")),
            {"body 'fan'", "180", "steps_per_second to at least 91"});
  expect_in(refusal(turning("motion.rotation = [[0, 0, 0, 0], [0.04, 0, 0, 360]]\n")), {"180"});
  expect_in(refusal(turning("angular_velocity = [0, 0, 200]\n")), {"191 degrees"});
  EXPECT_EQ(refusal(turning("motion.rotation = [[0, 0, 0, 0], [0.1, 0, 0, 360]]\n")), "");
  EXPECT_EQ(refusal(turning("angular_velocity = [0, 0, 180]\n")), "");
}

TEST(RunStatistics, BookWhatGasDoesToTheEnergy) {
  const std::string pumped =
      "duration = 0.5\nsimulation.steps_per_second = 240\nsimulation.gravity = [0, 0, 0]\n"
      "[ground]\npresent = false\n[[body]]\nradius = 1\nk_max = 1e9\nrho_g = 0\nsupply.n = ";
  for (const char* const supply : {"[[0, 0.1], [0.4, 0.3]]\n", "[[0, 0.3], [0.4, 0.1]]\n"}) {
    const RunStatistics run =
        run_statistics(scenes::parse_scene(pumped + supply, "pumped.toml"), 1);
    ASSERT_TRUE(run.gas_work);
    EXPECT_GT(std::abs(*run.gas_work), 10.0);
    EXPECT_NEAR(run.energy_end.total() - run.energy_start.total(), *run.gas_work,
                1e-3 * std::abs(*run.gas_work));
    EXPECT_LT(run.energy_rise.value, 1e-3 * std::abs(*run.gas_work));
  }
}

/// The loads of two of them that touch in the air come from the springs to the others, and change
/// their energy.
TEST(JoinBodies, BallsOnAChainHangAndLand) {
  std::string chain =
      "duration = 6\n[simulation]\nsteps_per_second = 120\n"
      "[[body]]\nname = \"b0\"\nkind = \"static\"\nshape = \"sphere\"\n"
      "radius = 0.5\nposition = [0, 0, 14]\n";
  for (int i = 1; i <= 5; ++i) {
    chain += fmt::format(
        "[[body]]\nname = \"b{}\"\nradius = 1\nrest = \"equilibrium\"\ngauge_pressure = 30\n"
        "mass = 1\nposition = [0, 0, {}]\n"
        "[[spring]]\nfrom = \"b{}\"\nto = \"b{}\"\nk = 100\ndamping = 2\n",
        i, 14.5 - 2.0 * i, i - 1, i);
  }
  const RunStatistics run = run_statistics(scenes::parse_scene(chain, "chain.toml"), 1);
  EXPECT_FALSE(run.divergence) << *run.divergence;
}

}  // namespace
}  // namespace pneuma::app
