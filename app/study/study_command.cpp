#include "app/study/study_command.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "app/terminal/common_options.h"

namespace pneuma::app {

void add_study_command(CLI::App& app, Action& action, std::span<const std::string> command_line) {
  CLI::App* study = app.add_subcommand("study", "Measure what choices cost and what they gain");
  study->require_subcommand(1);
  add_error_study(*study, action, command_line);
  add_accuracy_study(*study, action, command_line);
  add_choices_study(*study, action, command_line);
  add_collision_study(*study, action, command_line);
  add_contact_study(*study, action, command_line);
  add_growth_study(*study, action, command_line);
  add_extreme_study(*study, action, command_line);
  add_horizon_study(*study, action, command_line);
  add_impact_study(*study, action, command_line);
  add_solvers_study(*study, action, command_line);
  add_stability_study(*study, action, command_line);
  // Last, because commands below another begin with its examples.
  add_examples(*study, {"pneuma study error one_sphere --short", "pneuma study extremes"});
  add_examples(*study->get_subcommand("error"),
               {"pneuma study error one_sphere --free-flight",
                "pneuma study error one_sphere --free-flight --tumbling",
                "pneuma study error one_sphere one_torus --snakemake flow",
                "pneuma study error one_sphere --set body.k=80 --short"});
  add_examples(*study->get_subcommand("accuracy"),
               {"pneuma study accuracy one_sphere torus_four_cubes",
                "pneuma study accuracy one_sphere --short"});
  add_examples(*study->get_subcommand("choices"),
               {"pneuma study choices", "pneuma study choices one_torus --short --json"});
  add_examples(*study->get_subcommand("collision"),
               {"pneuma study collision sphere_in_torus", "pneuma study collision --seconds 2"});
  add_examples(*study->get_subcommand("contacts"), {"pneuma study contacts two_spheres_contact",
                                                    "pneuma study contacts one_sphere --short"});
  add_examples(*study->get_subcommand("growth"),
               {"pneuma study growth", "pneuma study growth --short --out out/growth"});
  add_examples(*study->get_subcommand("extremes"),
               {"pneuma study extremes", "pneuma study extremes --short --out out/extremes"});
  add_examples(*study->get_subcommand("horizons"),
               {"pneuma study horizons one_sphere sphere_in_torus",
                "pneuma study horizons two_spheres_contact --set simulation.contact=potential"});
  add_examples(*study->get_subcommand("impacts"),
               {"pneuma study impacts", "pneuma study impacts --runs 100 --seed 2"});
  add_examples(*study->get_subcommand("solvers"),
               {"pneuma study solvers", "pneuma study solvers --short"});
  add_examples(*study->get_subcommand("stability"),
               {"pneuma study stability", "pneuma study stability one_sphere --short",
                "pneuma study stability --snakemake flow"});
}

}  // namespace pneuma::app
