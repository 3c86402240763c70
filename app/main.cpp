// Command line -> action -> exit code.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "app/command.h"
#include "app/errors.h"
#include "app/interrupt.h"
#include "app/study/study_command.h"
#include "app/version.h"
#include "assets/model.h"
#include "render/context/context.h"
#include "render/image/file.h"
#include "scenes/load_scene.h"
#include "scenes/nearest.h"

namespace {

using namespace pneuma;
using app::ExitCode;

ExitCode fail(ExitCode code, const std::exception& error) {
  fmt::print(stderr, "pneuma: {}\n", error.what());
  return code;
}

/// The one place where an error becomes an exit code.
ExitCode run(const app::Action& action) {
  try {
    const ExitCode code = action();
    // Only now is it known whether what was printed arrived.
    if (std::fflush(stdout) != 0) throw render::IoError("cannot write to standard output");
    return code;
  } catch (const app::UsageError& error) {
    return fail(ExitCode::usage, error);
  } catch (const scenes::SceneError& error) {
    // As they are: each line starts with file:line:column, which editors jump to.
    fmt::print(stderr, "{}\n", error.what());
    return ExitCode::invalid_scene;
  } catch (const assets::ModelError& error) {
    fmt::print(stderr, "{}\n", error.what());  // starts with the file's path
    return ExitCode::invalid_scene;
  } catch (const render::GlError& error) {
    return fail(ExitCode::no_gl, error);
  } catch (const app::DivergenceError& error) {
    return fail(ExitCode::diverged, error);
  } catch (const render::IoError& error) {
    return fail(ExitCode::input_output, error);
  } catch (const std::system_error& error) {
    return fail(ExitCode::input_output, error);
  } catch (const app::Interrupted& error) {
    return fail(ExitCode::interrupted, error);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "pneuma: out of memory; make the scene or its pictures smaller\n");
    return ExitCode::input_output;
  } catch (const std::exception& error) {
    fmt::print(stderr, "pneuma: a mistake in the program itself: {}\n", error.what());
    return ExitCode::own_mistake;
  }
}

/// What to say when the first word is no command; none when it is one, or an option.
std::optional<std::string> unknown_command(const CLI::App& cli,
                                           const std::vector<std::string>& command_line) {
  if (command_line.size() < 2 || command_line[1].starts_with('-')) return std::nullopt;
  std::vector<std::string> names;
  for (const CLI::App* command : cli.get_subcommands({})) names.push_back(command->get_name());
  if (std::ranges::find(names, command_line[1]) != names.end()) return std::nullopt;
  return fmt::format("there is no command {}{}", scenes::in_quotes(command_line[1]),
                     scenes::suggestion_and_all(command_line[1], {names.begin(), names.end()}));
}

}  // namespace

int main(int argc, char** argv) {
  app::catch_signals();
  const std::vector<std::string> command_line(argv, argv + argc);
  app::Action action;

  CLI::App cli("Soft bodies held up by gas pressure, rendered off screen", "pneuma");
  cli.set_version_flag("--version", "pneuma " + app::version().program);
  cli.require_subcommand(1);
  app::add_render_command(cli, action, command_line);
  app::add_export_command(cli, action);
  app::add_bench_command(cli, action);
  app::add_study_command(cli, action, command_line);
  app::add_check_command(cli, action);
  app::add_list_command(cli, action);
  app::add_doctor_command(cli, action);
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (const auto unknown = unknown_command(cli, command_line)) {
      return static_cast<int>(fail(ExitCode::usage, app::UsageError(*unknown)));
    }
    return static_cast<int>(cli.exit(error) == 0 ? ExitCode::done : ExitCode::usage);
  }
  return static_cast<int>(run(action));
}
