// The subcommands. Each has a file of its own that adds its options to the command line; choosing
// the subcommand sets the action that main then runs.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "app/host/exit_code.h"

namespace CLI {
class App;
}

namespace pneuma::app {

/// May throw what app/host/errors.h lists; main turns each into a message and an exit code.
using Action = std::function<ExitCode()>;

/// `action` must outlive the parsing of the command line. `command_line` is what the user typed,
/// for the record of a run, and must outlive the action.
void add_render_command(CLI::App& app, Action& action, std::span<const std::string> command_line);
void add_export_command(CLI::App& app, Action& action);
void add_bench_command(CLI::App& app, Action& action);
void add_check_command(CLI::App& app, Action& action);
void add_list_command(CLI::App& app, Action& action);
void add_doctor_command(CLI::App& app, Action& action);

}  // namespace pneuma::app
