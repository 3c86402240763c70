#include "app/study/error/error_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/study/error/conclusions.h"
#include "tests/app/study/error/small_study.h"
#include "tests/support/json_numbers.h"

namespace pneuma::app {
namespace {

ErrorStudy study_with_all() {
  ErrorStudy study = made_up_study();
  study.runs = {made_up_unstable_run("martin", 15),
                made_up_run("martin", 30, 5e-2, 2e-4),
                made_up_run("martin", 60, 2.5e-2, 4e-4),
                made_up_run("martin", 120, 1.25e-2, 8e-4),
                made_up_unstable_run("rk4", 15),
                made_up_run("rk4", 30, 2e-3, 2e-4),
                made_up_run("rk4", 60, 1.25e-4, 4e-4),
                made_up_run("rk4", 120, 0.0, 8e-4),
                made_up_peer_run(1e-2, 9e-3, 1440e-6, 80.0)};
  study.runs[7].status = ErrorRun::Status::skipped;
  study.runs[7].failure = "the run before it took 20 s";
  return study;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(ErrorText, Fits120Columns) {
  ErrorStudy study = study_with_all();
  for (const char* more : {"symplectic_euler", "velocity_verlet", "implicit_one", "implicit_two"}) {
    for (const int rate : {15, 30, 60, 120}) {
      study.runs.insert(study.runs.begin(), made_up_run(more, rate, 1e-3, 0.123456789));
    }
  }
  study.reference.limit = "from then on nothing is known of it, for reasons that need some words";
  study.reference.method = std::string(40, 'm') + " " + std::string(40, 'n');
  for (const std::string& line : lines_of(error_text(study))) EXPECT_LE(line.size(), 120u) << line;
}

TEST(ErrorText, SaysTheConclusions) {
  const ErrorStudy study = study_with_all();
  const std::string text = error_text(study);
  const auto contains = [&](const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  for (const double error : recommended_errors) {
    EXPECT_TRUE(contains(recommendation(choose(study, error))));
  }
  EXPECT_TRUE(contains("martin            1.00, in theory 1 (fit over 3 steps, 1/30 to 1/120 s)"));
  EXPECT_TRUE(contains("rk4               no range of steps with a power law, in theory 4"));
  EXPECT_TRUE(contains("unstable"));
  EXPECT_TRUE(contains("skipped"));
  EXPECT_TRUE(contains("7.20x"));
}

TEST(ErrorText, WithContactsComparesOnlyOurs) {
  ErrorStudy study = study_with_all();
  study.runs.pop_back();
  study.flight.contacts = true;
  EXPECT_EQ(error_text(study).find("SUNDIALS"), std::string::npos);
}

TEST(RunsCsv, HasARowPerRunWithEmptyCellsWhereNothingWasMeasured) {
  const ErrorStudy study = study_with_all();
  const auto lines = lines_of(runs_csv(study));
  ASSERT_EQ(lines.size(), study.runs.size() + 1);
  EXPECT_TRUE(lines[1].starts_with(
      "made_up,martin,15,0.06666666666666667,,unstable,\"at 0.1 s: gone, and \"\"how\"\"\""));
  EXPECT_TRUE(lines[1].ends_with(",,,,,,,,,,"));
  EXPECT_TRUE(
      lines[2].starts_with("made_up,martin,30,0.03333333333333333,,stable,,0.0002,,0.025,"));
  EXPECT_TRUE(lines[9].starts_with("made_up,cvode_adams,,,0.01,stable,,0.00144,80,0.0045,"));
}

TEST(RatiosCsv, HasARowPerErrorCompared) {
  const auto lines = lines_of(ratios_csv(study_with_all()));
  ASSERT_EQ(lines.size(), compared_errors.size() + 1);
  EXPECT_EQ(lines[2],
            "made_up,0.01,rk4,0.03333333333333333,0.002,0.0002,cvode_adams,0.01,0.009,0.00144,7.2");
  EXPECT_EQ(lines[6], "made_up,1e-06,,,,,,,,,");
}

TEST(ErrorJson, SaysTheSameForMachines) {
  const auto json = nlohmann::json::parse(error_json(study_with_all()).dump());
  EXPECT_EQ(json["runs"].size(), 9u);
  EXPECT_EQ(json["runs"][0]["outcome"], "unstable");
  EXPECT_TRUE(json["runs"][0]["max"].is_null());
  EXPECT_EQ(json["runs"][1]["max"]["position"], 5e-2);
  EXPECT_EQ(json["choices"][1]["ours"]["method"], "rk4");
  EXPECT_NEAR(json["choices"][1]["sundials_over_ours"], 7.2, 1e-9);
  EXPECT_EQ(json["orders"][0]["observed"]["points"], 3);
  expect_nulls_only_at(
      json, {"/tolerance", "/steps_per_second", "/evaluations_per_simulated_s", "/end", "/max",
             "/ours", "/sundials", "/sundials_over_ours", "/observed"});
}

/// The series of unstable runs behind that of the name.
const DiagramSeries& unstable_series(const Diagram& diagram, std::string_view name) {
  const auto series = std::ranges::find_if(
      diagram.series, [&](const DiagramSeries& s) { return s.name.starts_with(name); });
  return *(series + 1);
}

TEST(ErrorDiagrams, ShowUnstableRunsAboveAllErrorsARowForEachMethod) {
  for (const Diagram& diagram : {work_diagram(study_with_all()), step_diagram(study_with_all())}) {
    const DiagramSeries& martin = unstable_series(diagram, "martin");
    const DiagramSeries& rk4 = unstable_series(diagram, "rk4");
    ASSERT_EQ(martin.points.size(), 1u);
    ASSERT_EQ(rk4.points.size(), 1u);
    EXPECT_GT(martin.points[0].y, 10.0);
    EXPECT_GT(rk4.points[0].y, martin.points[0].y);
    EXPECT_GT(diagram.y.high, rk4.points[0].y);
    for (const DiagramSeries& series : diagram.series) {
      if (series.name.empty()) continue;
      for (const DiagramPoint& point : series.points) EXPECT_LE(point.y, 10.0);
    }
    EXPECT_NO_THROW(gnuplot_script(diagram, "x"));
  }
}

TEST(ErrorDiagrams, PlaceRunsByTheirTimeOrStep) {
  const ErrorStudy study = study_with_all();
  EXPECT_DOUBLE_EQ(work_diagram(study).series[0].points[0].x, 200.0);  // microseconds
  EXPECT_DOUBLE_EQ(step_diagram(study).series[0].points[0].x, 1.0 / 30.0);
  EXPECT_EQ(work_diagram(study).series.size(), 6u);
  EXPECT_EQ(step_diagram(study).series.size(), 4u);  // SUNDIALS has no step of ours
}

TEST(ErrorDiagrams, HaveAPlaceForAnErrorOfNothing) {
  ErrorStudy study = made_up_study();
  study.runs = {made_up_run("rk4", 60, 0.0, 1e-4)};
  EXPECT_NO_THROW(gnuplot_script(work_diagram(study), "x"));
}

}  // namespace
}  // namespace pneuma::app
