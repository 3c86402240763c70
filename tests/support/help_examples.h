// The examples below the help of a command.
#pragma once

#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

namespace pneuma {

inline std::vector<std::string> help_examples(const CLI::App& command) {
  std::vector<std::string> examples;
  std::istringstream lines(command.help());
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  pneuma ")) examples.push_back(line.substr(2));
  }
  return examples;
}

/// Each command of `make()`, and each below it, has examples that a fresh one can read.
inline void expect_examples_that_can_be_read(const std::function<void(CLI::App&)>& make,
                                             const CLI::App& command) {
  for (const CLI::App* below : command.get_subcommands({})) {
    const auto examples = help_examples(*below);
    EXPECT_FALSE(examples.empty()) << below->get_name();
    for (const std::string& example : examples) {
      CLI::App fresh("", "pneuma");
      make(fresh);
      EXPECT_NE(example.find(' ' + below->get_name()), std::string::npos) << example;
      EXPECT_NO_THROW(fresh.parse(example, true)) << example;
    }
    expect_examples_that_can_be_read(make, *below);
  }
}

}  // namespace pneuma
