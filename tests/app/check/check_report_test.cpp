#include "app/check/check_report.h"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/record/world_json.h"
#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/support/json_numbers.h"

namespace pneuma::app {
namespace {

constexpr const char* sphere_text = R"(
duration = 0.5
[[body]]
kind = "soft"
shape = "sphere"
position = [0.0, 0.0, 3.0]
)";

CheckReport report_of(const char* text, bool with_run = false) {
  CheckReport report;
  report.scene = scenes::parse_scene(text, "test.toml");
  const sim::World world = build_world(report.scene);
  report.plan = sim::make_plan(world);
  report.size = world_size(world);
  report.steps = step_advices(world);
  report.gas = gas_advices(world);
  if (with_run) report.run = run_statistics(report.scene, 1);
  return report;
}

/// What stands after the name on its line, comment sign or not.
std::string after(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::string plain = line.starts_with("# ") ? line.substr(2) : line;
    if (!plain.starts_with("  " + name + ' ')) continue;
    return plain.substr(plain.find_first_not_of(' ', 2 + name.size()));
  }
  return "no line of " + name;
}

TEST(CheckText, SaysOfEveryStageWhetherItRuns) {
  const std::string text = check_text(report_of(sphere_text));
  for (const char* stage : {"integrate_soft", "find_contacts", "resolve_contacts"}) {
    EXPECT_EQ(after(text, stage), "runs");
  }
  for (const char* stage : {"integrate_rigid", "broad_phase", "move_particles", "depenetrate"}) {
    EXPECT_TRUE(after(text, stage).starts_with("left out: ")) << after(text, stage);
    EXPECT_GT(after(text, stage).size(), std::string("left out: ").size());
  }
  EXPECT_EQ(after(text, "soft_ground"), "runs");
  for (const char* kind : {"rigid_ground", "soft_soft", "soft_rigid", "rigid_rigid"}) {
    EXPECT_TRUE(after(text, kind).starts_with("left out: ")) << kind;
  }
}

TEST(CheckText, SaysHowLargeGasMakesABody) {
  // n = 10 mol, the default, in a ball of 98 m^3.
  const std::string text = check_text(report_of(sphere_text));
  EXPECT_NE(text.find("times) at rest without weight: BLOWN UP\n"), std::string::npos) << text;
  const auto gas = check_json(report_of(sphere_text)).at("gas").at(0);
  EXPECT_GT(gas.at("settled_volume_m3"), 10.0 * gas.at("volume_m3").get<double>());
  EXPECT_EQ(gas.at("blown_up"), true);
  const auto empty = check_json(report_of("[[body]]\nn = 0\n")).at("gas").at(0);
  EXPECT_EQ(empty.at("settled_volume_m3"), empty.at("volume_m3"));
  EXPECT_TRUE(empty.at("max_held_mol").is_null());
}

TEST(CheckText, SaysWhereEnergiesCountFrom) {
  EXPECT_NE(check_text(report_of(sphere_text, true))
                .find("gas without ambient pressure counts as 0 J at 1 m^3"),
            std::string::npos);
}

TEST(CheckText, IsASceneFileOfTheSameScene) {
  const CheckReport report = report_of(sphere_text, true);
  const scenes::Scene read = scenes::parse_scene(check_text(report), "test.toml");
  EXPECT_EQ(scenes::scene_fingerprint(read), scenes::scene_fingerprint(report.scene));
}

TEST(CheckText, EndsWithTheRun) {
  const std::string text = check_text(report_of(sphere_text, true));
  EXPECT_LT(text.find("[[body]]"), text.find("# Run of "));
  EXPECT_GT(text.find("state hash"), text.find("speed at the end"));
}

TEST(CheckText, HasTheRunOnlyWhenThereWasOne) {
  EXPECT_EQ(check_text(report_of(sphere_text)).find("state hash"), std::string::npos);
  EXPECT_NE(check_text(report_of(sphere_text, true)).find("state hash"), std::string::npos);
}

sim::Settings by_impulses(double skin_thickness) {
  sim::Settings settings;
  settings.contact = sim::ContactMethod::impulses;
  settings.skin_thickness = skin_thickness;
  return settings;
}

TEST(RunStatisticsText, CallsARoundingNoPenetrationAndHasNoSkinOfSweptContacts) {
  RunStatistics run;
  run.penetration = {2.8e-16, 1.0};
  EXPECT_EQ(after(run_statistics_text(run, by_impulses(0.5)), "penetration"), "none");
  run.penetration = {0.75, 1.25};
  sim::Settings swept;
  swept.contact = sim::ContactMethod::swept;
  EXPECT_EQ(run_statistics_text(run, swept).find("skin"), std::string::npos);
}

TEST(StartOverlapText, SaysWhenBodiesCameApart) {
  EXPECT_EQ(start_overlap_text({.pairs = 1, .left = 0, .parted = 0.4, .bodies = "a and b"}),
            "a and b: overlap from the start, parted by t = 0.40 s");
  EXPECT_NE(start_overlap_text({.pairs = 1, .left = 1, .parted = 0.0, .bodies = "a and b"})
                .find("still at the end"),
            std::string::npos);
}

TEST(RunStatisticsText, SaysWhetherPenetrationStaysBelowTheSkin) {
  RunStatistics run;
  EXPECT_EQ(after(run_statistics_text(run, by_impulses(0.5)), "penetration"), "none");
  run.penetration = {0.75, 1.25};
  run.penetration_bodies = "torus and cube";
  run.settled_penetration = 0.25;
  const std::string below = run_statistics_text(run, by_impulses(0.5));
  EXPECT_EQ(after(below, "penetration"), "greatest 0.7500 m at 1.25 s, of torus and cube");
  EXPECT_NE(below.find("0.2500 m, below the skin"), std::string::npos);
  EXPECT_NE(run_statistics_text(run, by_impulses(0.125)).find("NOT below"), std::string::npos);
}

TEST(RunStatisticsText, SaysHowFarTheGroundOfThePotentialYields) {
  RunStatistics run;
  run.penetration = {0.75, 1.25};
  sim::Settings settings;
  settings.contact = sim::ContactMethod::potential;
  settings.potential.distance = 0.25;
  EXPECT_NE(run_statistics_text(run, settings).find("the ground is up to 0.25 m"),
            std::string::npos);
}

TEST(RunStatistics, HaveTheHashOfTheStateInOneForm) {
  RunStatistics run;
  run.state_hash = 0x0123456789abcdef;
  EXPECT_EQ(run_statistics_json(run)["state_hash"], "0x0123456789abcdef");
  EXPECT_EQ(after(run_statistics_text(run, by_impulses(0.5)), "state hash"), "0x0123456789abcdef");
}

TEST(RunStatisticsText, SaysWhatTheEnergyLeavesOut) {
  RunStatistics run;
  const std::string plain = run_statistics_text(run, by_impulses(0.5));
  EXPECT_EQ(plain.find("pins that move"), std::string::npos);
  EXPECT_EQ(plain.find("gas without ambient pressure"), std::string::npos);
  run.pins_move = true;
  EXPECT_NE(run_statistics_text(run, by_impulses(0.5)).find("pins that move do work"),
            std::string::npos);
  EXPECT_EQ(plain.find("springs to moved bodies"), std::string::npos);
  run.springs_are_moved = true;
  EXPECT_NE(run_statistics_text(run, by_impulses(0.5)).find("springs to moved bodies do work"),
            std::string::npos);
}

TEST(RunStatisticsText, SaysAtRestOrNot) {
  RunStatistics run;
  run.at_end = run.liveliest_at_end = {0.9 * rest_speed, "ball"};
  run.rests_from = 2.5;
  EXPECT_NE(run_statistics_text(run, by_impulses(0.5))
                .find(": at rest (that is below 0.05 m/s for 0.5 s) from 2.50 s on"),
            std::string::npos);
  run.rests_from.reset();
  EXPECT_NE(run_statistics_text(run, by_impulses(0.5)).find(": not at rest yet"),
            std::string::npos);
  run.at_end.speed = run.liveliest_at_end.speed = 1.1 * rest_speed;
  EXPECT_NE(run_statistics_text(run, by_impulses(0.5)).find("m/s at most, of ball: not at rest"),
            std::string::npos);
}

TEST(RunStatisticsText, SaysWhatWasPressedToNextToNothing) {
  const auto text = [](bool keeps_gas, double least) {
    RunStatistics run;
    VolumeRange& ball = run.volumes.emplace_back();
    ball.body = "ball";
    ball.start.value = 2.0;
    ball.least.value = least;
    ball.keeps_gas = keeps_gas;
    return run_statistics_text(run, by_impulses(0.5));
  };
  EXPECT_NE(text(true, 0.1).find(": PRESSED to 5 %"), std::string::npos);
  EXPECT_EQ(text(false, 0.1).find("PRESSED"), std::string::npos);  // a balloon that leaks
  EXPECT_EQ(text(true, 0.3).find("PRESSED"), std::string::npos);
}

TEST(RunStatisticsText, SaysWhichVolumesAreNotToBeTrusted) {
  RunStatistics run;
  run.volumes.push_back(
      {.body = "bag", .start = {7.0}, .least = {5.0}, .greatest = {9.0, true}, .end = {8.0, true}});
  const std::string text = run_statistics_text(run, by_impulses(0.5));
  EXPECT_EQ(after(text, "volume"), "bag: 5.00 to 9.00* m^3, 7.00 at the start, 8.00* at the end");
  EXPECT_NE(text.find(" * not to be trusted"), std::string::npos) << text;
  run.volumes[0].greatest.crosses_itself = run.volumes[0].end.crosses_itself = false;
  EXPECT_EQ(run_statistics_text(run, by_impulses(0.5)).find('*'), std::string::npos);
}

TEST(RunStatisticsText, SaysHowItDiverged) {
  const std::string why = "ball: the volume is -1 m^3";
  const auto run = std::make_unique<RunStatistics>();
  run->divergence.emplace(why);
  const std::string text = run_statistics_text(*run, by_impulses(0.5));
  EXPECT_EQ(after(text, "DIVERGED"), why);
  EXPECT_EQ(text.find("speed at the end"), std::string::npos) << "it has no end";
}

TEST(CheckJson, SaysTheSameForMachines) {
  const auto json = nlohmann::json::parse(check_json(report_of(sphere_text, true)).dump());
  expect_nulls_only_at(json, {"/run/divergence", "/run/at_rest_from_s"});
  EXPECT_EQ(json["plan"]["stages"].size(), static_cast<std::size_t>(sim::stage_count));
  EXPECT_EQ(json["plan"]["stages"]["integrate_soft"]["runs"], true);
  EXPECT_EQ(json["plan"]["stages"]["broad_phase"]["runs"], false);
  EXPECT_TRUE(json["plan"]["stages"]["broad_phase"]["reason"].is_string());
  EXPECT_EQ(json["plan"]["contact_kinds"].size(),
            static_cast<std::size_t>(sim::contact_kind_count));
  EXPECT_EQ(json["run"]["steps"], 30);
  EXPECT_EQ(json["run"]["momentum"]["end"]["linear"].size(), 3U);
  EXPECT_TRUE(json["run"]["contacts_per_step"]["soft_ground"]["mean"].is_number());
  EXPECT_EQ(json["run"]["contacts_per_step"].size(), 4U + sim::contact_kind_count);
  EXPECT_EQ(json["run"]["units"], std::string(json_units));
  EXPECT_TRUE(check_json(report_of(sphere_text))["run"].is_null());
}

TEST(WorldSize, CountsBodiesAndTheirParts) {
  const sim::World world = build_world(scenes::parse_scene(R"(
[[body]]
kind = "soft"
shape = "sphere"
copies = [2, 1, 1]
spacing = [10.0, 10.0, 10.0]
position = [0.0, 0.0, 5.0]
[[body]]
kind = "soft"
shape = "torus"
radius = 6.0
tube_radius = 2.0
stacks = 16
slices = 16
position = [0.0, 30.0, 5.0]
[[body]]
kind = "rigid"
position = [0.0, -20.0, 5.0]
)",
                                                           "test.toml"));
  const WorldSize size = world_size(world);
  EXPECT_EQ(size.soft_bodies, 3);
  EXPECT_EQ(size.rigid_boxes, 1);
  EXPECT_EQ(size.meshes, 2);
  // Section 6.2: a sphere has 58, 168, 112; a torus 256, 768, 512.
  EXPECT_EQ(size.vertices, 2 * 58 + 256);
  EXPECT_EQ(size.springs, 2 * 168 + 768);
  EXPECT_EQ(size.triangles, 2 * 112 + 512);
  // Position and velocity of a vertex are four doubles each; a box has 13 numbers.
  EXPECT_EQ(size.state_bytes, (2 * 58 + 256) * 2 * 4 * 8 + 13 * 8);
}

}  // namespace
}  // namespace pneuma::app
