// Studies in parts: measured one by one and put together they are what one process measures.
#include "app/study/study_parts.h"

#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>

#include "app/files/find_scene.h"
#include "app/host/errors.h"
#include "app/study/stability/stability_parts.h"
#include "app/study/stability/stability_report.h"
#include "scenes/loader/load_scene.h"
#include "sim/base/file.h"
#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

using nlohmann::json;

/// Two parts that count how often they are measured.
struct CountedParts {
  int measured = 0;
  std::vector<StudyPart> parts = {{"first",
                                   [this] {
                                     return json{{"at", ++measured}};
                                   }},
                                  {"second", [this] {
                                     return json{{"at", ++measured}};
                                   }}};

  std::optional<std::vector<json>> run(std::vector<std::string> arguments,
                                       const std::filesystem::path& out) {
    arguments.insert(arguments.begin(), {"pneuma", "study", "counting"});
    if (!out.empty()) arguments.insert(arguments.end(), {"--out", out.string()});
    CLI::App app;
    SplitOptions typed;
    CLI::App* command = app.add_subcommand("study")->add_subcommand("counting");
    add_split_options(*command, typed, arguments, "");
    command->add_flag("--quiet");
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend() - 1);
    app.parse(reversed);
    return measure_parts(typed, {"counting", {{"counting.json"}}}, {}, parts);
  }
};

TEST(StudyParts, AreAllMeasuredHereUnlessOneIsAskedFor) {
  const TemporaryFolder folder;
  CountedParts study;
  EXPECT_EQ(study.run({}, folder.path()).value(), (std::vector<json>{{{"at", 1}}, {{"at", 2}}}));
  const TemporaryFolder other;
  EXPECT_FALSE(study.run({"--part", "second"}, other.path()));
  EXPECT_EQ(study.measured, 3);
  EXPECT_TRUE(std::filesystem::exists(other / "parts/second.json"));
  EXPECT_FALSE(std::filesystem::exists(other / "parts/first.json"));
}

TEST(StudyParts, AreGatheredInTheirOrderWithoutMeasuringAgain) {
  const TemporaryFolder folder;
  CountedParts study;
  study.run({"--part", "second"}, folder.path());
  study.run({"--part", "first", "--quiet"}, folder.path());
  EXPECT_EQ(study.run({"--gather"}, folder.path()).value(),
            (std::vector<json>{{{"at", 2}}, {{"at", 1}}}));
  EXPECT_EQ(study.measured, 2);
}

std::string message(CountedParts& study, const std::vector<std::string>& arguments,
                    const std::filesystem::path& out) {
  try {
    study.run(arguments, out);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "accepted";
}

TEST(StudyParts, ThatAreMissingOrOfAnotherStudyAreNamed) {
  const TemporaryFolder folder;
  CountedParts study;
  study.run({"--part", "first"}, folder.path());
  const std::string missing = message(study, {"--gather"}, folder.path());
  EXPECT_NE(missing.find("parts/second.json is missing; make it with: "), std::string::npos)
      << missing;
  EXPECT_TRUE(missing.ends_with("--out " + folder.path().string() + " --part second")) << missing;

  study.run({"--part", "second"}, folder.path());
  const std::string other = message(study, {"--gather", "--short"}, folder.path());
  EXPECT_NE(other.find("parts/first.json: it was measured by another command"), std::string::npos)
      << other;

  write_text(folder / "parts/second.json", "[1, 2");
  EXPECT_NE(message(study, {"--gather"}, folder.path()).find("is no part of a study; remove it"),
            std::string::npos);
}

TEST(StudyParts, ReplaceNothingUnasked) {
  const TemporaryFolder folder;
  CountedParts study;
  const std::string flow = (folder / "flow").string();
  study.run({"--part", "first"}, folder.path());
  study.run({"--snakemake", flow}, {});
  const auto expect_refused = [&](const std::vector<std::string>& arguments,
                                  const std::string& file) {
    const bool is_flow = file.starts_with("flow");
    const std::string said =
        message(study, arguments, is_flow ? std::filesystem::path() : folder.path());
    EXPECT_TRUE(said.starts_with((folder / file).string() + " is there already; ")) << said;
    EXPECT_NE(said.find("--overwrite"), std::string::npos) << said;
  };
  expect_refused({"--part", "first"}, "parts/first.json");
  expect_refused({}, "parts/first.json");
  expect_refused({"--snakemake", flow}, "flow/Snakefile");
  EXPECT_EQ(study.measured, 1);
  study.run({"--part", "first", "--overwrite"}, folder.path());
  study.run({"--part", "second"}, folder.path());
  EXPECT_TRUE(study.run({"--gather"}, folder.path()));
  write_text(folder / "counting.json", "mine");
  expect_refused({"--gather"}, "counting.json");
  EXPECT_TRUE(study.run({"--gather", "--overwrite"}, folder.path())) << "of the same command";
  EXPECT_TRUE(study.run({"--overwrite"}, folder.path()));
  EXPECT_FALSE(study.run({"--snakemake", flow, "--overwrite"}, {}));
}

TEST(StudyParts, RefuseAPartThatThereIsNotAndEqualNames) {
  const TemporaryFolder folder;
  CountedParts study;
  EXPECT_EQ(message(study, {"--part", "third"}, folder.path()),
            "--part third: the study's parts are first, second");
  study.parts[1].name = "first";
  EXPECT_TRUE(message(study, {}, folder.path()).starts_with("two parts of the study would be"));
  EXPECT_EQ(study.measured, 0);
}

TEST(StudyParts, AreListedInAWorkflowThatCallsThisProgram) {
  const TemporaryFolder folder;
  CountedParts study;
  EXPECT_FALSE(study.run({"--short", "--snakemake", (folder / "flow").string()}, {}));
  const std::string text = read_text(folder / "flow/Snakefile");
  EXPECT_NE(text.find("PARTS = [\n    \"first\",\n    \"second\",\n]"), std::string::npos) << text;
  EXPECT_NE(text.find(" study counting --short --out " + (folder / "flow").string() +
                      " --quiet --part {wildcards.part}\""),
            std::string::npos)
      << text;
  EXPECT_EQ(study.measured, 0);
}

TEST(PartName, HasNothingThatAShellOrAFolderReads) {
  EXPECT_EQ(part_name({"my scene/2", "rk4"}), "my_scene_2.rk4");
}

TEST(StabilityParts, GiveWhatOneProcessMeasures) {
  const scenes::Scene scene =
      scenes::load_scene(find_scene("one_sphere"), std::vector<std::string>{"body.n=1"});
  StabilityOptions options;
  options.trial = {.seconds = 0.5, .most_steps = 100};
  options.integrators = {sim::Integrator::symplectic_euler, sim::Integrator::implicit_euler};
  options.k = {10.0, 1e4};
  options.n = {2.0};
  options.map_rates = {60, 480};
  options.most_map_steps = 50;
  const auto quietly = [](const std::string&) {};
  const StabilityStudy whole = study_stability(scene, options, quietly);
  std::vector<json> parts;
  for (const sim::Integrator integrator : options.integrators) {
    StabilityOptions one = options;
    one.integrators = {integrator};
    parts.push_back(json::parse(part_json(study_stability(scene, one, quietly)).dump()));
  }
  const StabilityStudy joined = join_parts(options, parts);
  EXPECT_EQ(limits_csv(joined), limits_csv(whole));
  EXPECT_EQ(stability_json(joined), stability_json(whole));
  for (const sim::Integrator integrator : options.integrators) {
    EXPECT_EQ(gnuplot_script(stability_map(joined, integrator), "map"),
              gnuplot_script(stability_map(whole, integrator), "map"));
  }
}

TEST(StudyErrorInParts, IsGatheredFromScenesMeasuredOneByOne) {
  const TemporaryFolder folder;
  const std::string study = "study error one_sphere one_torus --short --free-flight --seconds 0.2";
  const auto run = [&](const std::string& how) {
    return run_pneuma(study + " --quiet --out '" + folder.path().string() + "' " + how + " 2>&1");
  };
  EXPECT_EQ(run("--gather").exit_code, 6);
  for (const char* scene : {"one_sphere", "one_torus"}) {
    const ProgramResult part = run(std::string("--part ") + scene);
    EXPECT_EQ(part.exit_code, 0) << part.output;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "error.json"));
  const ProgramResult gathered = run("--gather");
  EXPECT_EQ(gathered.exit_code, 0) << gathered.output;
  const json report = json::parse(read_text(folder / "error.json"));
  EXPECT_EQ(report["scenes"][0]["scene"], "one_sphere");
  EXPECT_EQ(report["scenes"][1]["scene"], "one_torus");
  for (const char* file : {"one_sphere_runs.csv", "one_torus_ratios.csv", "one_torus_work.gp"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
  }
}

}  // namespace
}  // namespace pneuma::app
