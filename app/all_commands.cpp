#include "app/all_commands.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "app/host/exit_code_words.h"
#include "app/host/version.h"
#include "app/runs/runs_commands.h"
#include "app/study/study_command.h"
#include "app/sweep/sweep_command.h"
#include "app/terminal/common_options.h"

namespace pneuma::app {

void add_all_commands(CLI::App& cli, Action& action, std::span<const std::string> command_line) {
  cli.name("pneuma");
  cli.description("Soft bodies held up by gas pressure, rendered off screen");
  cli.set_version_flag("--version", version_text);
  cli.require_subcommand(1);
  add_render_command(cli, action, command_line);
  add_export_command(cli, action);
  add_plot_command(cli, action);
  add_compare_command(cli, action);
  add_bench_command(cli, action);
  add_study_command(cli, action, command_line);
  add_sweep_command(cli, action, command_line);
  add_check_command(cli, action);
  add_list_command(cli, action);
  add_doctor_command(cli, action);
  add_examples(cli, {"pneuma doctor", "pneuma list", "pneuma render one_sphere --out pictures"});
  cli.footer(fmt::format("{}\n\nExit codes: {}", cli.get_footer(), exit_code_words));
}

}  // namespace pneuma::app
