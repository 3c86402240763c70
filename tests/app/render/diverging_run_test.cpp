// Runs that diverge, from the outside: what they say, what they leave, and how they go on.
#include <fmt/format.h>

#include <regex>

#include "tests/app/render/rendered_run.h"

namespace pneuma {
namespace {

using nlohmann::json;

// sqrt(k/m) of 5000 N/m and 0.35 kg over six springs per vertex: 290 rad/s, where rk4 at 60 steps
// per second is stable up to 2.8 * 60 = 170 rad/s.
const std::string too_stiff =
    "--set body.k=5000 --set body.k_max=1e9 --set simulation.steps_per_second=60 ";

void expect_words(const ProgramResult& result, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(result.output.find(word), std::string::npos) << result.output << "lacks " << word;
  }
}

/// What the expression's group is in the text; an empty string where it is not found.
std::string found(const std::string& text, const char* expression) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(expression)) ? match[1].str() : "";
}

/// The number of steps per second that the remedy names.
std::string advised_steps(const ProgramResult& result) {
  return found(result.output, R"(--set simulation\.steps_per_second=(\d+))");
}

TEST_F(RenderTest, SaysWhatDivergedWhyAndWhatToDo) {
  const ProgramResult result = render(too_stiff);
  EXPECT_EQ(result.exit_code, 5);
  expect_words(result, {"fall: step ", "(t = ", "integrate_soft: body ball: ", "vertex ",
                        "Likely the step of 0.0167 s is too long", "Use a step of ", "k = 5000 N/m",
                        "with rk4", "--set simulation.integrator=implicit_euler",
                        "frames so far are whole"});
  expect_whole(pictures());
}

TEST_F(RenderTest, WhatItAdvisesWorks) {
  const std::string steps = advised_steps(render(too_stiff));
  ASSERT_NE(steps, "");
  const ProgramResult shorter =
      render_into("shorter", too_stiff + "--set simulation.steps_per_second=" + steps);
  EXPECT_EQ(shorter.exit_code, 0) << shorter.output;
  EXPECT_EQ(shorter.output.find("stay stable"), std::string::npos) << shorter.output;
  const ProgramResult implicit =
      render_into("implicit", too_stiff + "--set simulation.integrator=implicit_euler");
  EXPECT_EQ(implicit.exit_code, 0) << implicit.output;
}

TEST_F(RenderTest, WarnsOfStepsThatAreTooLongBeforeItStarts) {
  const ProgramResult warned = render(too_stiff + "--frames 0-0");
  EXPECT_EQ(warned.exit_code, 0) << warned.output;
  expect_words(warned, {": warning: body 'ball': steps of 0.0167 s are longer than the ",
                        "small motions stay stable", "with rk4"});
  EXPECT_EQ(render("--overwrite --frames 0-0").output.find("stay stable"), std::string::npos);
}

TEST_F(RenderTest, WarnsOfBodiesThatGasBlowsUpBeforeItStarts) {
  const ProgramResult warned = render("--frames 0-0");
  expect_words(warned, {": warning: body 'ball': gas blows it up: ", "n of at most "});
  const ProgramResult held = render("--overwrite --frames 0-0 --set body.rest=equilibrium");
  EXPECT_EQ(held.output.find("warning"), std::string::npos) << held.output;
}

TEST_F(RenderTest, ADivergedRunGoesOnWithOtherSteps) {
  ASSERT_EQ(render(too_stiff).exit_code, 5);
  const auto so_far = pictures();
  ASSERT_FALSE(so_far.empty());
  EXPECT_EQ(render(too_stiff + "--resume").exit_code, 5) << "with the same steps it diverges again";
  const ProgramResult resumed =
      render(too_stiff + "--resume --set simulation.integrator=implicit_euler");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
  const auto all = pictures();
  EXPECT_EQ(all.size(), 22U);
  expect_whole(all);
  for (const auto& [name, bytes] : so_far) EXPECT_TRUE(all.at(name) == bytes) << name;
  const json changes = record()["changes"];
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0]["first_frame"], so_far.size());
  EXPECT_NE(changes[0]["reason"].get<std::string>().find("body ball"), std::string::npos);
}

TEST_F(RenderTest, ADivergedRunGoesOnWithOtherStepsOnly) {
  ASSERT_EQ(render(too_stiff).exit_code, 5);
  const ProgramResult result = render("--set body.k=50 --set body.k_max=1e9 --resume");
  EXPECT_EQ(result.exit_code, 6);
  expect_words(result, {"was  k = 5000", "is   k = 50", "but for simulation.*"});
  // What may be other is not named among what may not.
  const ProgramResult shorter =
      render(too_stiff + "--set simulation.integrator=implicit_euler --frames 0-10 --resume");
  EXPECT_EQ(shorter.exit_code, 6);
  expect_words(shorter, {"last_frame: was 21, is 10"});
  EXPECT_EQ(shorter.output.find("implicit_euler"), std::string::npos) << shorter.output;
}

TEST_F(RenderTest, ABodyWithoutRoomIsNotAdvisedOtherSteps) {
  write_text(scene(), std::string(falling_ball) +
                          "[[body]]\nname = \"plate\"\nkind = \"moved\"\nsize = [4, 4, 0.4]\n"
                          "position = [0, 0, 2.5]\n"
                          "motion.path = [[0, 0, 0, 0], [0.6, 0, 0, -2.45]]\n");
  const ProgramResult result = render("--set ball.n=0.1");
  EXPECT_EQ(result.exit_code, 5);
  expect_words(result, {"is crushed between plate and the ground", "let what is moved stop earlier",
                        "Let motion.path or motion.rotation leave more room", "--overwrite"});
  EXPECT_EQ(result.output.find("--set"), std::string::npos) << result.output;
}

TEST_F(RenderTest, ARunThatDivergedIsAdvisedWhatToAdd) {
  expect_words(render(too_stiff + "--on-divergence stop"),
               {"add --set simulation.steps_per_second=120 or --on-divergence substep to: "});
  expect_words(render(too_stiff + "--set body.k=5e10 --on-divergence substep --overwrite"),
               {"Not even 1024 parts", "add --set simulation.integrator=implicit_euler to: "});
}

TEST_F(RenderTest, AStepThatDivergesCanBeDoneInParts) {
  // 3.3 m in a step, and the ball is 2 m across: the ground presses it flat.
  const std::string thrown = "--set body.velocity='[0,0,-200]' ";
  const ProgramResult stopped = render(thrown + "--on-divergence stop");
  EXPECT_EQ(stopped.exit_code, 5);
  expect_words(stopped, {"resolve_contacts: body ball: its contacts pressed it flat"});
  const ProgramResult result = render(thrown + "--overwrite");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  expect_words(result, {"a step before t = 0.0333 s diverged; it was done again in ",
                        "1 step diverged and was done in parts"});
  EXPECT_EQ(record()["frames"][1].count("step_parts"), 1U);
  EXPECT_EQ(record()["frames"][2].count("step_parts"), 0U);
  EXPECT_EQ(record()["run"].count("on_divergence"), 0U);
}

TEST_F(RenderTest, StepsAreDoneInSoManyPartsAndNoMore) {
  // At 1e6 m/s even a 1024th of a step is 16 m long, and the ball 2 m across: it is put flat onto
  // the ground.
  const ProgramResult result = render(
      "--set body.velocity='[0,0,-1e6]' --set body.restitution=0 --set ground.restitution=0 "
      "--on-divergence substep");
  EXPECT_EQ(result.exit_code, 5) << result.output;
  expect_words(result, {"Not even 1024 parts of the step do"});
}

TEST(StiffFirmSphere, StopsInItsFirstSecondByRk4AndTheAdvisedStepWorks) {
  const std::string scene =
      "check pressure_firm --run --set body.k=1e6 --set body.n=1e4 "
      "--set simulation.steps_per_second=60 --set duration=";
  const ProgramResult stopped = run_pneuma(scene + "60 2>&1");
  EXPECT_EQ(stopped.exit_code, 5) << stopped.output;
  const std::string time = found(stopped.output, R"(\(t = ([0-9.]+) s\))");
  ASSERT_NE(time, "") << stopped.output;
  EXPECT_LT(std::stod(time), 1.0);
  const std::string steps = advised_steps(stopped);
  ASSERT_NE(steps, "") << stopped.output;
  const ProgramResult shorter =
      run_pneuma(scene + "1 --set simulation.steps_per_second=" + steps + " 2>&1");
  EXPECT_EQ(shorter.exit_code, 0) << shorter.output;
  EXPECT_EQ(shorter.output.find("warning"), std::string::npos) << shorter.output;
}

void expect_implicit_run(const std::string& seconds) {
  const ProgramResult result = run_pneuma(
      "check pressure_firm --run --json --set body.k=1e6 --set body.n=1e4 "
      "--set simulation.integrator=implicit_euler 2>/dev/null --set duration=" +
      seconds);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const json run = json::parse(result.output)["run"];
  EXPECT_TRUE(run["divergence"].is_null());
  EXPECT_EQ(run["steps"], 60 * std::stoi(seconds));
}

TEST(StiffFirmSphere, RunsImplicitlyAtTheUsualStep) { expect_implicit_run("2"); }

TEST(LongStiffFirmSphere, RunsImplicitlyForAMinuteAtTheUsualStep) { expect_implicit_run("60"); }

TEST(CheckSteps, SaysHowLongTheyMayBe) {
  const ProgramResult fine = run_pneuma("check one_sphere 2>&1");
  EXPECT_EQ(fine.exit_code, 0);
  expect_words(fine, {"Steps of soft bodies", "small motions stay stable up to "});
  EXPECT_EQ(fine.output.find("TOO LONG"), std::string::npos) << fine.output;

  const ProgramResult stiff =
      run_pneuma("check one_sphere --set body.k=9e4 --set simulation.steps_per_second=60 2>&1");
  EXPECT_EQ(stiff.exit_code, 0);
  expect_words(stiff,
               {"one_sphere.toml:", ": warning: body 'sphere': steps of 0.0167 s are longer than",
                "THE STEP IS TOO LONG", "with rk4"});

  const ProgramResult implicit = run_pneuma(
      "check one_sphere --json --set body.k=9e4 --set simulation.integrator=sdirk2 2>/dev/null");
  const json steps = json::parse(implicit.output)["steps"];
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_TRUE(steps[0]["stable_up_to_s"].is_null());
  EXPECT_EQ(steps[0]["too_long"], false);
}

}  // namespace
}  // namespace pneuma
