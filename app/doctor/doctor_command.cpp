// pneuma doctor: what is missing on this machine, and the command that mends it.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>

#include "app/doctor/diagnosis.h"
#include "app/terminal/command.h"
#include "app/terminal/common_options.h"

namespace pneuma::app {

void add_doctor_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("doctor", "Look at what the program needs here, and how to mend it");
  const auto backend = std::make_shared<std::optional<render::Backend>>();
  add_backend_option(*command, *backend);
  add_examples(*command, {"pneuma doctor", "pneuma doctor --backend egl"});
  command->callback([backend, &action] {
    action = [backend] {
      const std::vector<Finding> findings = diagnose(*backend);
      fmt::print("{}", diagnosis_text(findings));
      return exit_code(findings);
    };
  });
}

}  // namespace pneuma::app
