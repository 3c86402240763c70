// bench, check, list and doctor from the outside: what they print and how they end.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/host/build_info.h"
#include "tests/support/json_numbers.h"
#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {
namespace {

namespace fs = std::filesystem;

const std::string no_gl = "PNEUMA_GL=none";
const std::string small = " --set duration=0.5 --steps 3 --size 64x48 ";

TEST(Bench, PrintsARowPerScene) {
  const ProgramResult result = run_pneuma("bench one_torus one_sphere" + small);
  EXPECT_EQ(result.exit_code, 0);
  const std::size_t torus = result.output.find("\none_torus "),
                    sphere = result.output.find("\none_sphere ");
  ASSERT_NE(torus, std::string::npos);
  ASSERT_NE(sphere, std::string::npos);
  EXPECT_LT(torus, sphere);  // as asked for
  EXPECT_NE(result.output.find("64 x 48 pixels"), std::string::npos);
}

TEST(Bench, WithoutScenesMeasuresThePapers) {
  const ProgramResult result =
      run_pneuma("bench --no-pictures --json --set duration=0.5 --steps 3");
  EXPECT_EQ(result.exit_code, 0);
  const auto scenes = nlohmann::json::parse(result.output)["scenes"];
  ASSERT_GE(scenes.size(), 2u);
  EXPECT_EQ(scenes[0]["scene"], "one_sphere");
  EXPECT_EQ(scenes[0]["paper_fps"], 60.0);
  EXPECT_EQ(scenes[1]["scene"], "one_torus");
  for (const auto& scene : scenes) EXPECT_TRUE(scene["paper_fps"].is_number());
}

TEST(Bench, PrintsJsonWithoutANumberThatIsNotFinite) {
  const ProgramResult result = run_pneuma("bench one_sphere --json" + small);
  EXPECT_EQ(result.exit_code, 0);
  expect_nulls_only_at(
      nlohmann::json::parse(result.output),
      {"/stage_shares/integrate_rigid", "/stage_shares/broad_phase", "/stage_shares/move_particles",
       "/stage_shares/depenetrate", "/paper_method/not_measured_because"});
}

TEST(Bench, WithoutPicturesMakesNoGlContext) {
  EXPECT_EQ(run_pneuma("bench one_sphere --no-pictures" + small, no_gl).exit_code, 0);
  EXPECT_EQ(run_pneuma("bench one_sphere" + small + "2>&1", no_gl).exit_code, 4);
}

TEST(Bench, NamesADivergedSceneAndMeasuresTheOthers) {
  const ProgramResult result = run_pneuma(
      "bench one_torus --no-pictures --set body.k=1e12 --set simulation.integrator=martin" + small);
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(result.output.find("one_torus is missing"), std::string::npos);
}

TEST(Bench, RefusesWhatItDoesNotUnderstand) {
  EXPECT_EQ(run_pneuma("bench no_such_scene 2>&1").exit_code, 3);
  EXPECT_EQ(run_pneuma("bench one_sphere --steps 0 2>&1").exit_code, 2);
  EXPECT_EQ(run_pneuma("bench one_sphere --size big 2>&1").exit_code, 2);
  EXPECT_EQ(run_pneuma("bench one_sphere --steps 1 --seconds 1 2>&1").exit_code, 2);
}

TEST(Check, PrintsTheKeysAsJsonToo) {
  const auto keys = nlohmann::json::parse(run_pneuma("check --keys --json", no_gl).output);
  const std::string text = run_pneuma("check --keys", no_gl).output;
  const auto find = [&](const std::string& path) -> nlohmann::json {
    for (const auto& key : keys) {
      if (key["path"] == path) return key;
    }
    return {};
  };
  EXPECT_EQ(find("body.k"), nlohmann::json::parse(R"({"path": "body.k", "takes": "number",
      "words": null, "range": "k >= 0", "unit": "N/m", "default": 50.0,
      "only_for": "soft bodies without stiffness", "set_by_paper_method": false, "meaning": "spring constant"})"));
  EXPECT_EQ(find("simulation.integrator")["words"],
            (nlohmann::json{"martin", "symplectic_euler", "velocity_verlet", "rk4", "rk8",
                            "implicit_euler", "sdirk2"}));
  EXPECT_NE(
      find("simulation.integrator")["meaning"].get<std::string>().find(
          "under implicit_euler and martin their free spin dies away, under sdirk2 a fast one"),
      std::string::npos);
  EXPECT_EQ(find("simulation.gravity")["default"], (nlohmann::json{0.0, 0.0, -9.81}));
  EXPECT_EQ(find("ground.present")["default"], true);
  EXPECT_TRUE(find("camera.eye")["default"].is_null());
  // As many as the text has, where each key has a line with its default.
  std::size_t defaults = 0;
  for (std::size_t at = 0; (at = text.find("default", at)) != text.npos; ++at) ++defaults;
  EXPECT_EQ(keys.size(), defaults);
}

TEST(Check, PrintsWhatRunsAndWhatIsLeftOut) {
  const ProgramResult result = run_pneuma("check one_sphere", no_gl);
  EXPECT_EQ(result.exit_code, 0);
  std::vector<std::string> stages;
  std::istringstream lines(result.output);
  for (std::string line; std::getline(lines, line) && !line.starts_with("# Kinds of contact");) {
    if (line.find("left out: ") == std::string::npos) continue;
    std::string sign, stage;
    std::istringstream(line) >> sign >> stage;
    stages.push_back(stage);
  }
  EXPECT_EQ(stages, (std::vector<std::string>{"integrate_rigid", "broad_phase", "move_particles",
                                              "depenetrate"}));
}

TEST(Check, RunsTheScene) {
  const ProgramResult result =
      run_pneuma("check one_sphere --run --json --set duration=0.5", no_gl);
  EXPECT_EQ(result.exit_code, 0);
  const auto json = nlohmann::json::parse(result.output);
  expect_nulls_only_at(json, {"/run/divergence", "/run/at_rest_from_s"});
  EXPECT_EQ(json["run"]["steps"], 30);
}

TEST(Check, LeavesOutTheSceneIfThatIsAskedFor) {
  const std::string command = "check one_sphere --run --set duration=0.5";
  const std::string run = run_pneuma(command + " --no-scene", no_gl).output;
  EXPECT_TRUE(run.starts_with("Run of 30 steps, 0.5 s\n")) << run;
  // The same lines as comments below the scene.
  std::string comments;
  std::istringstream lines(run);
  for (std::string line; std::getline(lines, line);) comments += "# " + line + '\n';
  EXPECT_TRUE(run_pneuma(command, no_gl).output.ends_with("\n" + comments)) << run;

  auto json = nlohmann::json::parse(run_pneuma(command + " --json --no-scene", no_gl).output);
  EXPECT_EQ(json.size(), 2u);
  EXPECT_EQ(json["scene"], "one_sphere");
  EXPECT_EQ(json["run"]["steps"], 30);
  EXPECT_EQ(run_pneuma("check one_sphere --no-scene 2>&1", no_gl).exit_code, 2);
}

TEST(Check, EndsWith5WhenTheRunDiverges) {
  const ProgramResult result = run_pneuma(
      "check one_sphere --run --set body.k=1e12 --set simulation.integrator=martin "
      "--set simulation.steps_per_second=60 2>/dev/null");
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(result.output.find("DIVERGED"), std::string::npos);
}

TEST(Check, SaysWhyItDivergedBelowTheReport) {
  const ProgramResult result = run_pneuma(
      "check one_sphere --run --set body.k=1e12 --set simulation.integrator=martin "
      "--set simulation.steps_per_second=60 2>&1");
  EXPECT_LT(result.output.find("state hash"), result.output.rfind("pneuma: "));
}

TEST(Check, EndsWith7WhenBodiesPassThroughEachOther) {
  const std::string run = "check torus_four_cubes --run --set duration=2 ";
  const ProgramResult crossing =
      run_pneuma(run + "--set simulation.contact=impulses 2>&1 >/dev/null", no_gl);
  EXPECT_EQ(crossing.exit_code, 7);
  EXPECT_NE(crossing.output.find("torus_four_cubes: bodies pass through each other in "),
            std::string::npos)
      << crossing.output;
  EXPECT_NE(crossing.output.find("torus and "), std::string::npos) << crossing.output;
  EXPECT_NE(crossing.output.find("--set simulation.contact=swept"), std::string::npos);
  const ProgramResult apart = run_pneuma(run + "2>&1", no_gl);
  EXPECT_EQ(apart.exit_code, 0) << apart.output;
}

TEST(Check, PrintsAllErrorsOfAScene) {
  const ProgramResult result =
      run_pneuma("check one_sphere --set body.vertex_mass=-1 --set body.nn=3 2>&1");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.output.find("vertex_mass"), std::string::npos);
  EXPECT_NE(result.output.find("nn"), std::string::npos);
}

TEST(Check, PrintsTheReferenceOfKeysWithoutAScene) {
  const ProgramResult result = run_pneuma("check --keys");
  EXPECT_EQ(result.exit_code, 0);
  for (const char* key : {"vertex_mass", "steps_per_second", "elevation"}) {
    EXPECT_NE(result.output.find(key), std::string::npos) << key;
  }
  EXPECT_EQ(run_pneuma("check 2>&1").exit_code, 2);
}

TEST(Commands, EndWith6WhenTheirOutputIsLost) {
  // Longer than stdio's buffer, and shorter.
  EXPECT_EQ(run_pneuma("check --keys > /dev/full 2>/dev/null").exit_code, 6);
  EXPECT_EQ(run_pneuma("list > /dev/full 2>/dev/null").exit_code, 6);
}

TEST(List, HasEverySceneFile) {
  const ProgramResult text = run_pneuma("list"), json = run_pneuma("list --json");
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_EQ(json.exit_code, 0);
  std::vector<std::string> listed;
  for (const auto& scene : nlohmann::json::parse(json.output)) listed.push_back(scene["scene"]);
  for (const auto& file : fs::directory_iterator(PNEUMA_SOURCE_FOLDER "/scenes")) {
    if (file.path().extension() != ".toml") continue;
    const std::string name = file.path().stem().string();
    EXPECT_NE(text.output.find('\n' + name + ' '), std::string::npos) << name;
    EXPECT_NE(std::ranges::find(listed, name), listed.end()) << name;
  }
}

TEST(List, HasEverySweepByName) {
  const std::string listed = '\n' + run_pneuma("list --sweeps").output;
  for (const auto& file : fs::directory_iterator(PNEUMA_SOURCE_FOLDER "/scenes/sweeps")) {
    if (file.path().extension() != ".toml") continue;
    const std::string name = file.path().stem().string();
    EXPECT_NE(listed.find('\n' + name + '\n'), std::string::npos) << name << listed;
  }
}

TEST(List, ShowsInvalidScenesAndGoesOn) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "scenes");
  write_text(folder / "scenes/broken.toml", "duration = -1\n");
  const std::string there = "cd '" + folder.path().string() + "' &&";
  const ProgramResult list = run_pneuma("list", there);
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_NE(list.output.find("INVALID: "), std::string::npos);
  EXPECT_NE(list.output.find("\none_sphere "), std::string::npos);  // of the program's own folder
  const ProgramResult doctor = run_pneuma("doctor", there);
  EXPECT_EQ(doctor.exit_code, 0);
  EXPECT_NE(doctor.output.find("to mend it: pneuma check broken"), std::string::npos);
}

TEST(Doctor, EndsWith0WhereAllWorks) {
  const ProgramResult result = run_pneuma("doctor");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("All that is required works."), std::string::npos);
}

TEST(Doctor, EndsWith4WithoutGlAndSaysWhatMendsIt) {
  const ProgramResult result = run_pneuma("doctor", no_gl);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.output.find("to mend it: unset PNEUMA_GL"), std::string::npos);
  EXPECT_NE(result.output.find("good      PNG files"), std::string::npos);  // goes on looking
}

TEST(Doctor, EndsWith6WhereNoPngCanBeWritten) {
  const ProgramResult result = run_pneuma("doctor", "TMPDIR=/nonexistent");
  EXPECT_EQ(result.exit_code, 6);
  EXPECT_NE(result.output.find("export TMPDIR="), std::string::npos);
}

TEST(Doctor, EndsWith6InAFolderWhereNothingCanBeWritten) {
  const ProgramResult result = run_pneuma("doctor", "cd /proc &&");  // closed to the superuser, too
  EXPECT_EQ(result.exit_code, 6);
  EXPECT_NE(result.output.find("BROKEN    disk"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("to mend it: cd to a folder"), std::string::npos) << result.output;
}

TEST(Doctor, SaysHowToInstallWhatItCanDoWithout) {
  const ProgramResult result = run_pneuma("doctor", "PATH=/nonexistent");
  EXPECT_EQ(result.exit_code, 0);  // only render --video and the studies' diagrams need them
  EXPECT_NE(result.output.find("to mend it: sudo apt-get install ffmpeg"), std::string::npos);
  EXPECT_NE(result.output.find("to mend it: sudo apt-get install gnuplot-nox"), std::string::npos);
}

}  // namespace
}  // namespace pneuma
