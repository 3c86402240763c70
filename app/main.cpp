// Command line -> action -> exit code.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "app/all_commands.h"
#include "app/host/failure.h"
#include "app/host/interrupt.h"
#include "app/host/standard_streams.h"
#include "app/terminal/read_command_line.h"
#include "sim/base/file.h"

namespace {

using namespace pneuma;
using app::ExitCode;

ExitCode run(const app::Action& action) {
  try {
    const ExitCode code = action();
    // Only now is it known whether what was printed arrived.
    if (std::fflush(stdout) != 0) throw base::IoError("cannot write to standard output");
    return code;
  } catch (...) {
    std::fflush(stdout);  // what was printed before stands before
    const app::Failure failure = app::failure_of(std::current_exception());
    app::print_message("{}{}\n", failure.is_placed ? "" : "pneuma: ", failure.words);
    return failure.code;
  }
}

}  // namespace

int main(int argc, char** argv) {
  app::open_closed_streams();
  app::catch_signals();
  const std::vector<std::string> command_line(argv, argv + argc);
  app::Action action;

  CLI::App cli;
  app::add_all_commands(cli, action, command_line);
  return static_cast<int>(
      run([&] { return app::read_command_line(cli, command_line) ? action() : ExitCode::done; }));
}
