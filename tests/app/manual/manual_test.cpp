// Manual page and completions, and that the README's commands are examples of --help.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>

#include "app/all_commands.h"
#include "app/manual/write_manual.h"
#include "tests/support/paths.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

CommandModel program() {
  CLI::App cli;
  Action action;
  add_all_commands(cli, action, {});
  return command_model(cli);
}

CommandModel command_named(const std::vector<const CommandModel*>& all,
                           const std::vector<std::string>& path) {
  return **std::ranges::find(all, path, [](const CommandModel* each) { return each->path; });
}

TEST(CommandModel, HasNamesValuesChoicesAndExamples) {
  const CommandModel whole = program();
  const auto all = flattened(whole);
  EXPECT_EQ(all.front()->path, std::vector<std::string>());
  const CommandModel render = command_named(all, {"render"});
  const auto option = [&](const std::string& name) {
    return *std::ranges::find(render.options, name,
                              [](const OptionModel& each) { return each.names.back(); });
  };
  EXPECT_EQ(option("--help").names, (std::vector<std::string>{"-h", "--help"}));
  EXPECT_EQ(option("--out").value, "DIR");
  EXPECT_EQ(option("--quiet").value, "");
  EXPECT_EQ(option("--on-divergence").choices, (std::vector<std::string>{"stop", "substep"}));
  EXPECT_EQ(render.positionals.at(0).value, "SCENE|MODEL");
  EXPECT_EQ(command_named(all, {"study", "error"}).positionals.at(0).repeated, true);
}

/// The commands of the README's section, without their comments.
std::vector<std::string> readme_commands() {
  std::ifstream readme(project_folder() / "README.md");
  std::vector<std::string> commands;
  for (std::string line; std::getline(readme, line);) {
    if (!line.starts_with("pneuma ")) continue;
    const std::string command = line.substr(0, line.find('#'));
    commands.push_back(command.substr(0, command.find_last_not_of(' ') + 1));
  }
  return commands;
}

TEST(Help, HasTheReadmesCommandsForExamples) {
  const CommandModel whole = program();
  std::vector<std::string> examples;
  for (const CommandModel* command : flattened(whole)) {
    examples.insert(examples.end(), command->examples.begin(), command->examples.end());
  }
  EXPECT_GT(readme_commands().size(), 15u);
  for (const std::string& command : readme_commands()) {
    EXPECT_NE(std::ranges::find(examples, command), examples.end()) << command;
  }
}

/// As a manual page has it.
std::string escaped(const std::string& text) {
  return std::regex_replace(std::regex_replace(text, std::regex(R"(\\)"), R"(\e)"), std::regex("-"),
                            R"(\-)");
}

TEST(ManualPage, HasEveryCommandOptionAndExample) {
  const CommandModel whole = program();
  const std::string page = manual_page(whole, "1.2");
  const auto expect = [&](const std::string& part) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  };
  expect(".TH PNEUMA 1 \"\" \"pneuma 1.2\"");
  const auto all = flattened(whole);
  EXPECT_GT(all.size(), 15u);
  for (const CommandModel* command : all) {
    std::string name = "pneuma";
    for (const std::string& word : command->path) name += " " + word;
    expect(".SS " + name + "\n" + escaped(command->description) + ".\n");
    for (const OptionModel& option : command->options) {
      const std::string value =
          option.value.empty() ? "" : " \\fI" + escaped(option.value) + "\\fR";
      expect(fmt::format(".TP\n\\fB{}\\fR{}\n{}\n",
                         escaped(fmt::format("{}", fmt::join(option.names, ", "))), value,
                         escaped(option.description)));
    }
    for (const std::string& example : command->examples) {
      expect(".EX\n" + escaped(example) + "\n.EE\n");
    }
  }
}

/// What bash offers for the last of the words, in a folder of its own.
std::string offered_by_bash(const std::string& words, const TemporaryFolder& folder = {}) {
  write_text(folder / "pneuma.bash", bash_completion(program()));
  const std::string script =
      "source pneuma.bash; complete -p pneuma > complete; compopt() { echo \"$@\" > compopt; }; "
      "pneuma() { if [[ $2 == --sweeps ]]; then printf '%s\\n' a_sweep 'a_$(touch pwned)'; else "
      "printf '\"scene\": \"%s\",\\n' a_scene 'a_$(touch pwned).toml'; fi; }; " +
      ("COMP_WORDS=(" + words + "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); ") +
      "_pneuma; echo \"${COMPREPLY[*]}\"";
  write_text(folder / "script", script);
  const ProgramResult result =
      run_command("cd '" + folder.path().string() + "' && bash script 2>&1");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  return result.output.substr(0, result.output.find('\n'));
}

TEST(BashCompletion, OffersCommandsOptionsChoicesAndScenes) {
  EXPECT_EQ(offered_by_bash("pneuma re"), "render");
  EXPECT_EQ(offered_by_bash("pneuma study sta"), "stability");
  EXPECT_EQ(offered_by_bash("pneuma render --over"), "--overlay --overwrite");
  EXPECT_EQ(offered_by_bash("pneuma render --on-divergence s"), "stop substep");
  EXPECT_EQ(offered_by_bash("pneuma render a_"), "a_scene");
  EXPECT_EQ(offered_by_bash("pneuma sweep a_"), "a_sweep");
  EXPECT_EQ(offered_by_bash("pneuma render --frames 1"), "");
}

// Scenes are called after their files, which whoever made them named.
TEST(BashCompletion, RunsNothingThatASceneIsCalled) {
  const TemporaryFolder folder;
  EXPECT_EQ(offered_by_bash("pneuma render a_", folder), "a_scene");
  EXPECT_EQ(offered_by_bash("pneuma sweep a_", folder), "a_sweep");
  EXPECT_FALSE(std::filesystem::exists(folder / "pwned"));
}

// To what it takes for files, bash adds a slash where a folder is called so.
TEST(BashCompletion, TakesOnlyFilesAndScenesForFiles) {
  const auto takes_for_files = [](const std::string& words) {
    const TemporaryFolder folder;
    offered_by_bash(words, folder);
    EXPECT_EQ(read_text(folder / "complete"), "complete -F _pneuma pneuma\n");
    return std::filesystem::exists(folder / "compopt");
  };
  EXPECT_FALSE(takes_for_files("pneuma rend"));
  EXPECT_FALSE(takes_for_files("pneuma render --on-divergence s"));
  EXPECT_TRUE(takes_for_files("pneuma render a_"));
  EXPECT_TRUE(takes_for_files("pneuma render --out a_"));
}

TEST(ZshCompletion, CallsAFunctionForEachCommand) {
  const CommandModel whole = program();
  const std::string text = zsh_completion(whole);
  EXPECT_TRUE(text.starts_with("#compdef pneuma\n"));
  EXPECT_NE(text.find("    render) _pneuma_render ;;\n"), std::string::npos);
  EXPECT_NE(text.find("_pneuma_study_error() {\n"), std::string::npos);
  EXPECT_NE(text.find(":DIR:_files -/'"), std::string::npos);
}

TEST(FishCompletion, HasALineForEachOption) {
  const std::string text = fish_completion(program());
  EXPECT_NE(text.find("complete -c pneuma -n '__fish_seen_subcommand_from render' -l out "
                      "-x -a '(__fish_complete_directories)' -d '"),
            std::string::npos);
  EXPECT_NE(text.find("-f -a stability -d '"), std::string::npos);
}

}  // namespace
}  // namespace pneuma::app
