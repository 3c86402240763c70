#include "app/bench/bench_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/json_numbers.h"

namespace pneuma::app {
namespace {

constexpr double micro = 1e-6;
constexpr double milli = 1e-3;

/// Two bodies, a step of 100 us, a frame of 5 ms.
SceneTimes two_bodies() {
  SceneTimes times;
  times.name = "torus_three_spheres_four_cubes";  // the longest name there is
  times.paper_fps = 50.0;
  times.bodies = 2;
  times.measured_from = 2.0;
  times.measured_to = 10.0;
  times.steps = 1000;
  times.step_seconds = {80.0 * micro, 100.0 * micro, 125.0 * micro};
  times.frames = FrameTimes{.frames = 20,
                            .width = 640,
                            .height = 480,
                            .seconds = {4.0 * milli, 5.0 * milli, 8.0 * milli},
                            .steps = 0.1 * milli,
                            .build = 0.2 * milli,
                            .draw = 3.5 * milli,
                            .encode = 1.2 * milli};
  sim::Contact contact;
  contact.first.kind = sim::SideKind::soft;
  contact.second.kind = sim::SideKind::soft;
  times.contacts.add(std::vector(3, contact));
  times.contacts.add({});
  times.stage_shares = {0.5, 0.0, 0.125, 0.25, 0.125, 0.0};
  times.plan.stages[1] = {false, "no rigid box"};
  return times;
}

BenchReport report_of(std::vector<SceneTimes> scenes) {
  BenchReport report;
  report.scenes = std::move(scenes);
  report.date = "2026-01-02T03:04:05Z";
  return report;
}

/// The cells of the `index`-th line that starts with the scene's name: one for each table.
std::vector<std::string> row(const std::string& text, const std::string& scene, int index) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(scene + ' ') || index-- > 0) continue;
    std::istringstream cells(line);
    std::vector<std::string> result;
    for (std::string cell; cells >> cell;) result.push_back(cell);
    return result;
  }
  return {};
}

using Cells = std::vector<std::string>;

TEST(BenchText, GivesFramesPerSecondBesideThePapers) {
  SceneTimes scene = two_bodies();
  scene.paper_method.fps = Spread{10'000.0, 12'000.0, 14'000.0};
  const std::string text = bench_text(report_of({scene}));
  // 1 / 100 us, 1 / 125 us, 1 / 80 us; 1 / 5 ms, 1 / 8 ms, 1 / 4 ms; over 50.
  EXPECT_EQ(row(text, scene.name, 0), (Cells{scene.name, "50", "10,000", "8,000", "12,500", "200x",
                                             "12,000", "200", "125", "250", "4.00x"}));
}

TEST(BenchText, GivesTheStepAndItsContacts) {
  const SceneTimes scene = two_bodies();
  const std::string text = bench_text(report_of({scene}));
  EXPECT_EQ(row(text, scene.name, 1),
            (Cells{scene.name, "100", "80.0", "125", "2", "1.50", "1.50", "50%"}));
}

TEST(BenchText, GivesTheShareOfEachStageOrThatItIsLeftOut) {
  const SceneTimes scene = two_bodies();
  const std::string text = bench_text(report_of({scene}));
  EXPECT_EQ(row(text, scene.name, 2),
            (Cells{scene.name, "50%", "-", "12%", "25%", "12%", "0%", "0%"}));
}

TEST(BenchText, GivesThePartsOfAFrame) {
  const SceneTimes scene = two_bodies();
  const std::string text = bench_text(report_of({scene}));
  EXPECT_EQ(row(text, scene.name, 3),
            (Cells{scene.name, "5.00", "4.00", "8.00", "0.100", "0.200", "3.50", "1.20", "20"}));
}

TEST(BenchText, SaysWhatElseWasDrawn) {
  BenchReport report = report_of({two_bodies()});
  EXPECT_EQ(bench_text(report).find("also drawn"), std::string::npos);
  report.options.show.particles = true;
  EXPECT_NE(bench_text(report).find("also drawn: particles"), std::string::npos);
  EXPECT_EQ(bench_json(report)["show"], "particles");
}

TEST(BenchText, AFrameOfSeveralStepsTakesAsManyTimesAsLong) {
  SceneTimes scene = two_bodies();
  scene.steps_per_frame = 4;
  EXPECT_EQ(row(bench_text(report_of({scene})), scene.name, 0).at(2), "2,500");
}

TEST(BenchText, SaysWhyThePapersMethodWasNotMeasured) {
  SceneTimes scene = two_bodies();
  EXPECT_EQ(row(bench_text(report_of({scene})), scene.name, 0).at(6), "-");
  scene.paper_method.reason = "no equilibrium";
  const std::string text = bench_text(report_of({scene}));
  EXPECT_NE(text.find(scene.name + " as printed: no equilibrium."), std::string::npos) << text;
}

TEST(BenchText, WithoutPicturesOrThePaperHasNoSuchColumns) {
  SceneTimes scene = two_bodies();
  scene.frames.reset();
  scene.paper_fps.reset();
  const std::string text = bench_text(report_of({scene}));
  EXPECT_EQ(row(text, scene.name, 0),
            (Cells{scene.name, "-", "10,000", "8,000", "12,500", "-", "-"}));
  EXPECT_EQ(text.find("picture"), std::string::npos);
  EXPECT_TRUE(row(text, scene.name, 3).empty());
}

TEST(BenchText, Fits120Columns) {
  SceneTimes slow = two_bodies();
  slow.step_seconds = {98765.0 * micro, 123456.0 * micro, 345678.0 * micro};
  slow.bodies = 12345;
  BenchReport report = report_of({two_bodies(), slow});
  slow.processor_share = 0.5;
  report.warnings = measurement_warnings(std::vector(20, slow));
  std::istringstream lines(bench_text(report));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("Program:") || line.starts_with("Machine:")) continue;  // as they come
    EXPECT_LE(line.size(), 120u) << line;
  }
}

TEST(BenchText, SaysMachineDateAndWarnings) {
  BenchReport report = report_of({two_bodies()});
  report.warnings = {"the machine is busy"};
  const std::string text = bench_text(report);
  EXPECT_NE(text.find("Machine: "), std::string::npos);
  EXPECT_NE(text.find(report.date), std::string::npos);
  EXPECT_NE(text.find("Warning: the machine is busy."), std::string::npos);
}

TEST(BenchText, SaysWhenStepsWereTooShortForTheClock) {
  SceneTimes scene = two_bodies();
  EXPECT_EQ(bench_text(report_of({scene})).find("per reading"), std::string::npos);
  scene.steps_per_reading = 7;
  EXPECT_NE(bench_text(report_of({scene})).find("7 steps per reading"), std::string::npos);
}

TEST(BenchJson, SaysTheSameForMachines) {
  SceneTimes plain = two_bodies();
  plain.frames.reset();
  plain.paper_fps.reset();
  const auto json = nlohmann::json::parse(bench_json(report_of({two_bodies(), plain})).dump());
  expect_nulls_only_at(json["scenes"][0], {"/stage_shares/integrate_rigid", "/paper_method/fps",
                                           "/paper_method/not_measured_because"});
  expect_nulls_only_at(json["scenes"][1], {"/stage_shares/integrate_rigid", "/paper_method/fps",
                                           "/paper_method/not_measured_because", "/paper_fps",
                                           "/simulation_over_paper", "/picture"});
  const auto& scene = json["scenes"][0];
  // 1e-9: the decimal digits of JSON, and one rounding.
  EXPECT_NEAR(scene["simulation_fps"]["median"], 10'000.0, 1e-9 * 10'000.0);
  EXPECT_NEAR(scene["simulation_over_paper"], 200.0, 1e-9 * 200.0);
  EXPECT_NEAR(scene["picture"]["over_paper"], 4.0, 1e-9 * 4.0);
  EXPECT_EQ(scene["contacts_per_step"]["all"]["max"], 3);
  EXPECT_EQ(scene["contacts_per_step"]["soft_soft"]["mean"], 1.5);
  EXPECT_EQ(json["date"], "2026-01-02T03:04:05Z");
  EXPECT_TRUE(json["machine"]["cpu"].is_string());
  EXPECT_TRUE(json["program"]["build_type"].is_string());
}

TEST(MeasurementWarnings, NameTheScenesThatWereInterrupted) {
  SceneTimes quiet = two_bodies(), disturbed = two_bodies();
  quiet.name = "quiet";
  disturbed.name = "disturbed";
  disturbed.processor_share = 0.5;
  EXPECT_TRUE(measurement_warnings({quiet}).empty());
  const auto warnings = measurement_warnings({quiet, disturbed});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("50%"), std::string::npos);
  EXPECT_NE(warnings[0].find("disturbed"), std::string::npos);
  EXPECT_EQ(warnings[0].find("quiet"), std::string::npos);
}

}  // namespace
}  // namespace pneuma::app
