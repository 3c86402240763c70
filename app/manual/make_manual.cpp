// Run by the build: writes manual page and completions into a folder.
//   pneuma_make_manual FOLDER
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <span>
#include <string>

#include "app/all_commands.h"
#include "app/host/version.h"
#include "app/manual/write_manual.h"
#include "sim/base/file.h"

namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  pneuma::base::write_file_atomically(
      path.string(), {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void write_all(const std::filesystem::path& folder) {
  using namespace pneuma::app;
  CLI::App cli;
  Action action;
  add_all_commands(cli, action, {});
  const CommandModel program = command_model(cli);
  std::filesystem::create_directories(folder);
  write(folder / "pneuma.1", manual_page(program, version().program));
  write(folder / "pneuma.bash", bash_completion(program));
  write(folder / "_pneuma", zsh_completion(program));
  write(folder / "pneuma.fish", fish_completion(program));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: pneuma_make_manual FOLDER\n", stderr);
    return 2;
  }
  try {
    write_all(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pneuma_make_manual: %s\n", error.what());
    return 6;
  }
}
