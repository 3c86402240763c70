#include "app/check/run_statistics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "app/check/check_report.h"
#include "app/check/judge_run.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

RunStatistics statistics_of(const char* text, const std::vector<std::string>& overrides = {}) {
  return run_statistics(scenes::parse_scene(text, "test.toml", overrides), 1);
}

/// A sphere that is blown up in empty space.
constexpr const char* free_sphere = R"(
duration = 0.5
[ground]
present = false
[simulation]
gravity = [0.0, 0.0, 0.0]
[[body]]
name = "balloon"
kind = "soft"
shape = "sphere"
radius = 1.0
velocity = [1.0, 0.0, 0.0]
rho_g = 0.0
)";

TEST(RunStatistics, OfAFreeSoftBodyKeepsMomentumAndLosesEnergy) {
  const RunStatistics run = statistics_of(free_sphere);
  EXPECT_FALSE(run.divergence);
  EXPECT_EQ(run.steps, 30);
  EXPECT_DOUBLE_EQ(run.seconds, 0.5);
  EXPECT_TRUE(run.pushed_by.empty());
  // 58 vertices of 0.35 kg at 1 m/s.
  EXPECT_NEAR(run.momentum_start.linear.x(), 58 * 0.35, 1e-12);
  // Without drag nothing acts from outside; what is left is rounding, 30 steps of 58 sums.
  EXPECT_LT((run.momentum_end.linear - run.momentum_start.linear).norm(), 1e-9);
  EXPECT_LT(run.energy_end.total(), run.energy_start.total());
  EXPECT_GE(run.energy_span, run.energy_start.total() - run.energy_end.total());
  EXPECT_EQ(run.contacts.all.sum, 0);
  EXPECT_EQ(run.penetration.value, 0.0);
  EXPECT_EQ(run.frames, 16);  // 30 a second, and the start
  EXPECT_EQ(run.crossings.frames + run.self_crossings.frames, 0);
  EXPECT_EQ(run.end_overlap, 0.0);
}

TEST(RunStatistics, HaveSpeedsOverAFrame) {
  // A ball that nothing blows up falls for half a second: in the last frame, of two steps, by its
  // mean velocity.
  const RunStatistics run = statistics_of(
      free_sphere, {"body.n=0", "body.velocity=[0, 0, 0]", "simulation.gravity=[0, 0, -9.81]"});
  EXPECT_NEAR(run.at_end.speed, 9.81 * (0.5 - 1.0 / 60.0), 1e-9);
  EXPECT_EQ(run.at_end.body, "balloon");
}

/// Boxes without weight that do nothing but what is said of them.
std::string drifting(const std::string& boxes) {
  return "duration = 1\n[ground]\npresent = false\n[simulation]\ngravity = [0, 0, 0]\n" + boxes;
}

TEST(RunStatistics, CallSmallBodiesAtRestByTheirSize) {
  const auto rests = [](const std::string& size, const std::string& speed) {
    const std::string text = drifting("[[body]]\nkind = \"rigid\"\nsize = [0.001, 0.001, " + size +
                                      "]\nvelocity = [" + speed + ", 0, 0]\nrho_g = 0\n");
    return statistics_of(text.c_str()).rests_from.has_value();
  };
  EXPECT_TRUE(rests("2", "0.04"));  // no size makes it more than rest_speed
  EXPECT_FALSE(rests("2", "0.06"));
  EXPECT_TRUE(rests("0.01", "0.0004"));
  EXPECT_FALSE(rests("0.01", "0.0006"));
}

/// A rod about its own axis, and a cube about one of its axes: by the distance of a corner from it.
TEST(RunStatistics, GiveTheSpeedOfACorner) {
  const RunStatistics run =
      statistics_of(drifting("[[body]]\nkind = \"rigid\"\nsize = [0.06, 4, 0.08]\nrho_g = 0\n"
                             "angular_velocity = [0, 100, 0]\n")
                        .c_str());
  EXPECT_NEAR(run.at_end.speed, 100.0 * 0.05, 1e-9);
}

/// Boxes that touch are moved apart by two millimetres each, without a velocity.
TEST(RunStatistics, SeeBoxesMoveWithoutAVelocity) {
  const RunStatistics run = statistics_of(
      "duration = 1\n[[body]]\nkind = \"rigid\"\nsize = [1, 1, 1]\nposition = [0, 0, 0.5]\n"
      "copies = [1, 1, 10]\nspacing = [0, 0, 1]\n");
  ASSERT_TRUE(run.rests_from);
  EXPECT_GT(*run.rests_from, 0.05);
  EXPECT_LT(*run.rests_from, 0.5);
}

TEST(RunStatistics, TellTheLiveliestFromTheFastest) {
  const std::string text = drifting(
      "[[body]]\nname = \"large\"\nkind = \"rigid\"\nvelocity = [0.04, 0, 0]\nrho_g = 0\n"
      "[[body]]\nname = \"small\"\nkind = \"rigid\"\nposition = [0, 9, 0]\n"
      "size = [0.1, 0.1, 0.1]\nvelocity = [0.01, 0, 0]\nrho_g = 0\n");
  const RunStatistics run = statistics_of(text.c_str());
  EXPECT_EQ(run.at_end.body, "large");
  EXPECT_EQ(run.liveliest_at_end.body, "small");
  EXPECT_DOUBLE_EQ(run.liveliest_at_end.limit, 0.1 * rest_speed);
  const std::string said = run_statistics_text(run, {});
  EXPECT_NE(said.find("0.04 m/s at most, of large: not at rest, as small with 0.01 m/s is (that is "
                      "below 0.005 m/s)"),
            std::string::npos)
      << said;
}

TEST(RunStatistics, CallAtRestWhatIsSlowForAWhile) {
  // By drag alone 0.07 m/s become 0.05 m/s in 0.56 s.
  const std::string text =
      drifting("[[body]]\nkind = \"rigid\"\nvelocity = [0.07, 0, 0]\nrho_g = 0.01\n");
  const RunStatistics early = statistics_of(text.c_str());
  EXPECT_LT(early.at_end.speed, rest_speed);
  EXPECT_FALSE(early.rests_from);
  EXPECT_NE(run_statistics_text(early, {}).find("not at rest"), std::string::npos);
  const RunStatistics late = statistics_of(text.c_str(), {"duration=1.1"});
  ASSERT_TRUE(late.rests_from);
  EXPECT_NEAR(*late.rests_from, 0.6, 0.001) << "the end of the first frame with less all along";
}

TEST(RunStatistics, LeaveOutTheSpeedOfWhatMovesAsItIsTold) {
  constexpr const char* belts =
      "duration = 0.5\n[[body]]\nname = \"belt\"\nkind = \"moved\"\nshape = \"box\"\n"
      "velocity = [3, 0, 0]\n[[body]]\nname = \"wheel\"\nkind = \"moved\"\nshape = \"sphere\"\n"
      "position = [0, 9, 0]\nvelocity = [4, 0, 0]\n";
  const RunStatistics run = statistics_of(belts);
  EXPECT_EQ(run.at_end.speed, 0.0);
  EXPECT_EQ(run.at_end.body, "");
}

TEST(RunStatistics, SayThatThePinsMove) {
  const std::string pulled =
      std::string(free_sphere) +
      "pinned = [[-9, -9, 0.5, 9, 9, 9]]\nmotion.path = [[0, 0, 0, 0], [1, 0, 0, 1]]\n";
  EXPECT_TRUE(statistics_of(pulled.c_str()).pins_move);
  EXPECT_FALSE(statistics_of(free_sphere).pins_move);
}

TEST(RunStatistics, SayThatSpringsAreMoved) {
  const auto towed_by = [](const std::string& kind) {
    return std::string(free_sphere) + "[[body]]\nname = \"tow\"\nkind = \"" + kind +
           "\"\nshape = \"sphere\"\nposition = [0, 0, 9]\n" +
           (kind == "moved" ? "velocity = [0, 0, 1]\n" : "") +
           "[[spring]]\nfrom = \"tow\"\nto = \"balloon\"\n";
  };
  EXPECT_TRUE(statistics_of(towed_by("moved").c_str()).springs_are_moved);
  EXPECT_FALSE(statistics_of(towed_by("static").c_str()).springs_are_moved);
}

TEST(RunStatistics, TellPressureAndGasThatComes) {
  const std::string text = std::string(free_sphere) + "supply.n = [[0.1, 0], [0.4, 0.5]]\n" +
                           "[[body]]\nname = \"shut\"\nposition = [9, 0, 0]\nn = 1.5\n" +
                           "[[body]]\nposition = [-9, 0, 0]\nn = 0\n";
  const RunStatistics run = statistics_of(text.c_str());
  ASSERT_EQ(run.gas.size(), 2u);
  EXPECT_EQ(run.gas[0].body, "balloon");
  EXPECT_EQ(run.gas[0].n.end, 0.5);
  EXPECT_GT(run.gas[0].n.start, 0.0) << "the first there is";
  EXPECT_EQ(run.gas[1].n.least, 1.5);
  EXPECT_EQ(run.gas[1].n.greatest, 1.5);
  // P = nRT / V, of the volume at the same end.
  const double pressure = 0.5 * sim::gas_constant * 293.15 / run.volumes[0].end.value;
  EXPECT_NEAR(run.gas[0].pressure.end, pressure, 1e-9 * pressure);
  EXPECT_GE(run.gas[0].pressure.greatest, run.gas[0].pressure.end);
  EXPECT_LE(run.gas[1].pressure.least, run.gas[1].pressure.end);

  const std::string said = run_statistics_text(run, {});
  EXPECT_NE(said.find("0.500 mol, "), std::string::npos) << said;
  EXPECT_EQ(said.find("1.50 mol"), std::string::npos) << "it stays: " << said;
  EXPECT_EQ(run_statistics_json(run)["gas"][1]["n_mol"]["end"], 1.5);
}

TEST(RunStatistics, TellThatGasHasGone) {
  const std::string text = std::string(free_sphere) + "supply.n = [[0, 0.2], [0.3, 0]]\n";
  const RunStatistics run = statistics_of(text.c_str());
  ASSERT_EQ(run.gas.size(), 1u);
  EXPECT_EQ(run.gas[0].n.greatest, 0.2);
  EXPECT_EQ(run.gas[0].n.end, 0.0);
  EXPECT_EQ(run.gas[0].pressure.end, 0.0);
}

TEST(RunStatistics, NameTheBodiesThatStartInEachOther) {
  const RunStatistics run = statistics_of(R"(
duration = 0.1
[simulation]
gravity = [0, 0, 0]
[[body]]
name = "left"
kind = "rigid"
size = [2, 2, 2]
position = [0, 0, 5]
[[body]]
name = "right"
kind = "rigid"
size = [1, 1, 4]
position = [0.5, 0.1, 5.2]
)");
  EXPECT_EQ(run.start_overlap.pairs, 1);
  EXPECT_EQ(run.start_overlap.bodies, "left and right");
  EXPECT_EQ(run.crossings.frames, 0);  // what is so from the start is no passing through
  EXPECT_EQ(run.self_crossings.frames, 0);
}

TEST(RunStatistics, TellObstaclesFromSoftBodies) {
  const RunStatistics run = statistics_of(R"(
duration = 0.5
[ground]
present = false
[[body]]
name = "stone"
kind = "static"
shape = "sphere"
rotation = [10, 20, 30]
[[body]]
name = "ball"
radius = 1.0
n = 0.05
rest = "equilibrium"
position = [0, 0, 4.1]
)");
  EXPECT_GT(run.contacts.with_obstacles.most, 0);
  EXPECT_EQ(run.contacts.with_obstacles.sum, run.contacts.all.sum);
  EXPECT_EQ(run.contacts.of(sim::ContactKind::soft_soft).sum, 0);
  const std::string text = run_statistics_text(run, {});
  EXPECT_NE(text.find("ball: at most"), std::string::npos) << text;
  EXPECT_EQ(text.find("stone"), std::string::npos) << text;
  EXPECT_EQ(text.find("soft_soft"), std::string::npos) << text;
  EXPECT_NE(text.find("soft bodies with static or moved ones"), std::string::npos) << text;
}

TEST(RunStatistics, BookTheWorkOfMovedBoxes) {
  // A plate at 2 m/s meets a box of 1 kg at rest, which leaves it at 4 m/s: 8 J.
  const char* pushed = R"(
duration = 1.0
[ground]
present = false
[simulation]
gravity = [0.0, 0.0, 0.0]
[[body]]
kind = "moved"
size = [1.0, 4.0, 4.0]
velocity = [2.0, 0.0, 0.0]
restitution = 1.0
[[body]]
kind = "rigid"
position = [2.0, 0.0, 0.0]
mass = 1.0
restitution = 1.0
rho_g = 0.0
)";
  const RunStatistics run = statistics_of(pushed);
  ASSERT_TRUE(run.driven_work);
  // The impulse is solved for to a part of the skin.
  EXPECT_NEAR(*run.driven_work, 8.0, 1e-6);
  EXPECT_NEAR(run.energy_end.total() - run.energy_start.total(), *run.driven_work, 1e-6);
  EXPECT_LT(run.energy_rise.value, 1e-6);
  EXPECT_FALSE(statistics_of(free_sphere).driven_work);
}

TEST(RunStatistics, FollowTheVolumeOfEachBody) {
  const RunStatistics run = statistics_of(free_sphere);
  ASSERT_EQ(run.volumes.size(), 1u);
  EXPECT_EQ(run.volumes[0].body, "balloon");
  const double start = run.volumes[0].start.value;
  EXPECT_EQ(run.volumes[0].least.value, start);  // gas of 10 mol only blows it up
  EXPECT_GT(run.volumes[0].greatest.value, 2.0 * start);
  // The mesh is inscribed in the sphere.
  EXPECT_LT(start, 4.0 / 3.0 * std::numbers::pi);
  EXPECT_GT(start, 2.0);
}

TEST(RunStatistics, MarkVolumesOfWhatCrossesItself) {
  // The top of a bag is led down through its bottom, a little aside.
  const RunStatistics run = statistics_of(R"(
duration = 0.5
[ground]
present = false
[simulation]
gravity = [0, 0, 0]
[[body]]
name = "bag"
shape = "box"
divisions = 2
size = [2, 2, 2]
n = 0
pinned = [[-9, -9, -9, 9, 9, -0.9], [-9, -9, 0.9, 9, 9, 9]]
motion.still = [[-9, -9, -9, 9, 9, -0.9]]
motion.path = [[0, 0, 0, 0], [0.5, 0.3, 0.2, -3]]
)");
  const VolumeRange& bag = run.volumes.at(0);
  EXPECT_NEAR(bag.start.value, 8.0, 1e-12);
  EXPECT_LT(bag.end.value, 0.0) << "inside out";
  EXPECT_FALSE(bag.start.crosses_itself || bag.greatest.crosses_itself);
  EXPECT_TRUE(bag.least.crosses_itself && bag.end.crosses_itself);
}

TEST(RunStatistics, AreNotOfAFreeSceneUnderGravityOrOnAGround) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(statistics_of(free_sphere, {"simulation.gravity=[0, 0, -9.81]"}).pushed_by,
            Names{"gravity"});
  EXPECT_EQ(statistics_of(free_sphere, {"ground.present=true"}).pushed_by, Names{"the ground"});
  EXPECT_EQ(statistics_of(free_sphere, {"body.rho_g=0.01"}).pushed_by, Names{"the air (rho_g)"});
  EXPECT_EQ(
      statistics_of(free_sphere, {"ground.present=true", "balloon.position=[0, 0, 50]"}).pushed_by,
      Names());
}

TEST(RunStatistics, CountContactsAndPenetrationOnTheGround) {
  const RunStatistics run = statistics_of(R"(
duration = 1.0
[[body]]
kind = "soft"
shape = "sphere"
radius = 1.0
position = [0.0, 0.0, 1.0]
)");
  EXPECT_FALSE(run.divergence);
  EXPECT_EQ(run.contacts.steps, 60);
  EXPECT_GT(run.contacts.of(sim::ContactKind::soft_ground).most, 0);
  EXPECT_EQ(run.contacts.all.sum, run.contacts.of(sim::ContactKind::soft_ground).sum);
  EXPECT_LE(run.settled_penetration, run.penetration.value);
  EXPECT_EQ(run.settled_contacts.steps, 30);
  EXPECT_NEAR(run.start_penetration, 0.0, 1e-15);  // the pole's height is 1 - 1, rounded
  EXPECT_LE(run.penetration.time, 1.0);
}

/// What is a million times as heavy presses the boxes below it into the ground.
TEST(RunStatistics, TellBoxesThatAreInTheGround) {
  constexpr const char* heavy_on_light = R"(
duration = 1.5
[[body]]
kind = "rigid"
size = [3, 3, 3]
mass = 1e6
position = [0, 0, 4]
[[body]]
name = "under"
kind = "rigid"
size = [1, 1, 1]
mass = 0.01
position = [-1.2, -1.2, 0.5]
copies = [2, 2, 2]
spacing = [2.4, 2.4, 1]
)";
  const RunStatistics run = statistics_of(heavy_on_light);
  EXPECT_GT(run.sunk.frames, 0);
  EXPECT_GT(run.sunk.depth.value, 0.01);
  EXPECT_EQ(run.sunk.body.find("under"), 0u) << run.sunk.body;
  const scenes::Scene scene = scenes::parse_scene(heavy_on_light, "heavy_on_light.toml");
  EXPECT_EQ(judge_run(scene, run).code, ExitCode::check_failed);
  const RunStatistics alike = statistics_of(heavy_on_light, {"body.1.mass=0.1"});
  EXPECT_EQ(alike.sunk.frames, 0);
}

TEST(RunStatistics, EndWhereTheRunDiverges) {
  const RunStatistics run =
      statistics_of(free_sphere, {"body.k=1e12", "simulation.integrator=martin"});
  ASSERT_TRUE(run.divergence);
  EXPECT_NE(run.divergence->find("balloon"), std::string::npos);
  EXPECT_LT(run.steps, 30);
}

TEST(RunStatistics, DoNotDependOnThreads) {
  const scenes::Scene scene = scenes::parse_scene(free_sphere, "test.toml");
  EXPECT_EQ(run_statistics(scene, 1).state_hash, run_statistics(scene, 2).state_hash);
}

}  // namespace
}  // namespace pneuma::app
