// Command line -> action -> exit code.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "app/all_commands.h"
#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/terminal/read_command_line.h"
#include "assets/model.h"
#include "render/context/context.h"
#include "scenes/loader/load_scene.h"
#include "sim/base/file.h"

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
    if (std::fflush(stdout) != 0) throw base::IoError("cannot write to standard output");
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
  } catch (const base::IoError& error) {
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
    return ExitCode::internal_error;
  }
}

}  // namespace

int main(int argc, char** argv) {
  app::catch_signals();
  const std::vector<std::string> command_line(argv, argv + argc);
  app::Action action;

  CLI::App cli;
  app::add_all_commands(cli, action, command_line);
  return static_cast<int>(
      run([&] { return app::read_command_line(cli, command_line) ? action() : ExitCode::done; }));
}
