// The command line from the outside: what is refused, and which words the message names.
#include <gtest/gtest.h>

#include "app/terminal/command.h"
#include "tests/support/help_examples.h"
#include "tests/support/run_pneuma.h"

namespace pneuma {
namespace {

std::string complaint_about(const std::string& arguments) {
  const ProgramResult result = run_pneuma(arguments + " 2>&1 >/dev/null");
  EXPECT_EQ(result.exit_code, 2) << arguments << '\n' << result.output;
  return result.output;
}

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(SetOption, TakesOneValueAndLeavesTheSceneAlone) {
  for (const char* command :
       {"check", "bench --no-pictures --steps 1", "export --format none", "render --threads 0"}) {
    const ProgramResult result = run_pneuma(
        std::string(command) + " --set body.k=nonsense no_such_scene --set duration=1 2>&1");
    EXPECT_EQ(result.output.find("PATH=VALUE"), std::string::npos) << result.output;
    EXPECT_EQ(result.output.find("required"), std::string::npos) << result.output;
  }
  EXPECT_EQ(run_pneuma("check --set body.k=60 one_sphere --set duration=1").exit_code, 0);
  EXPECT_EQ(run_pneuma("check one_sphere --set body.k=60 --set duration=1").exit_code, 0);
  EXPECT_EQ(run_pneuma("bench --no-pictures --steps 1 --set duration=1 one_sphere").exit_code, 0);
}

TEST(SetOption, WithoutAValueIsAMisuse) {
  EXPECT_SAYS(complaint_about("check one_sphere --set duration"),
              "--set: duration: expected PATH=VALUE in one word, such as duration=2");
  for (const char* typed : {"check one_sphere --set duration 2", "check --set duration 2"}) {
    EXPECT_SAYS(complaint_about(typed), "expected PATH=VALUE in one word");
  }
}

TEST(SetOption, BeforeTheSceneIsApplied) {
  EXPECT_SAYS(run_pneuma("check --set body.k=61.5 one_sphere").output, "k = 61.5");
}

TEST(Help, ListsTheExitCodes) {
  EXPECT_SAYS(run_pneuma("--help").output, "Exit codes: 0 done; 1 ");
}

TEST(Help, IsAskedForByAWordToo) {
  EXPECT_EQ(run_pneuma("help").output, run_pneuma("--help").output);
  EXPECT_EQ(run_pneuma("help study error").output, run_pneuma("study error --help").output);
  EXPECT_EQ(run_pneuma("help").exit_code, 0);
  const ProgramResult unknown = run_pneuma("help scene 2>&1");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.output.find("there is no command 'scene'"), std::string::npos)
      << unknown.output;
}

TEST(EmptyValue, IsNoValue) {
  for (const char* typed : {"render one_sphere --out ''", "export one_sphere --out ''",
                            "render one_sphere --video ''", "check ''"}) {
    EXPECT_SAYS(complaint_about(typed), "its value is empty");
  }
  EXPECT_SAYS(complaint_about("render one_sphere --out ''"), "--out: ");
}

TEST(UnknownOption, IsNamedWithTheNearestAndWithoutTheWordsBehindIt) {
  const std::string text = complaint_about("render --frame 10 one_sphere --set duration=1");
  EXPECT_SAYS(text, "pneuma render has no option '--frame'; did you mean '--frames'? allowed: ");
  EXPECT_SAYS(text, "`pneuma render --help`");
  EXPECT_EQ(text.find("one_sphere"), std::string::npos) << text;
  EXPECT_SAYS(complaint_about("list --jsno=1"), "'--jsno'; did you mean '--json'?");
  EXPECT_SAYS(complaint_about("study error --shrot"), "pneuma study error has no option '--shrot'");
}

TEST(UnknownOption, OfOtherCommandsNamesThem) {
  EXPECT_SAYS(complaint_about("--keys"), "; pneuma sweep and pneuma check have it\n");
  EXPECT_SAYS(complaint_about("check one_sphere --turntable 30"), "; pneuma render has it\n");
  EXPECT_EQ(complaint_about("list --nonsense").find("has it"), std::string::npos);
}

TEST(ExtraWords, AreListedAsTyped) {
  EXPECT_SAYS(complaint_about("render a b c d"), "does not expect: b c d\n");
}

TEST(Study, ThatDoesNotExistIsAnsweredWithThoseThatDo) {
  EXPECT_SAYS(
      complaint_about("study eror one_sphere"),
      "there is no study 'eror'; did you mean 'error'? allowed: error, accuracy, choices, ");
  EXPECT_SAYS(complaint_about("study"), "pneuma study needs a study; allowed: error, ");
  EXPECT_SAYS(complaint_about(""), "pneuma needs a command; allowed: render, ");
}

TEST(Help, HasExamplesThatCanBeRead) {
  app::Action action;
  const auto make = [&](CLI::App& cli) {
    app::add_render_command(cli, action, {});
    app::add_export_command(cli, action);
    app::add_bench_command(cli, action);
    app::add_check_command(cli, action);
    app::add_list_command(cli, action);
    app::add_doctor_command(cli, action);
  };
  CLI::App cli("", "pneuma");
  make(cli);
  expect_examples_that_can_be_read(make, cli);
  EXPECT_SAYS(run_pneuma("--help").output, "Examples:\n  pneuma ");
}

TEST(Version, NamesWhatTheProgramIsMadeOf) {
  const std::string text = run_pneuma("--version").output;
  EXPECT_TRUE(text.starts_with("pneuma 0.")) << text;
  for (const char* part : {"\n  commit ", "\n  compiler ", "Mesa ", "\n  Eigen ", "\n  GLEW "}) {
    EXPECT_SAYS(text, part);
  }
  EXPECT_SAYS(run_pneuma("--version", "PNEUMA_GL=none").output, "\n  OpenGL ");
}

TEST(SizeOption, HasAPictureSizeForAnExample) {
  for (const char* command : {"render one_sphere", "bench one_sphere"}) {
    EXPECT_SAYS(complaint_about(std::string(command) + " --size 640"), "such as 640x480");
  }
  EXPECT_SAYS(complaint_about("render one_sphere --sheet 4"), "such as 4x3");
}

}  // namespace
}  // namespace pneuma
