#include "app/runs/runs_commands.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>

#include "app/runs/compare_runs.h"
#include "app/runs/plot_run.h"
#include "app/terminal/common_options.h"

namespace pneuma::app {

void add_plot_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("plot", "Energy, volume, pressure, contacts and stage times of a run");
  const auto request = std::make_shared<PlotRequest>();
  command->add_option("RUN", request->run, "Folder of a render, finished or not")
      ->required()
      ->type_name("DIR");
  command->add_option("--out", request->out, "Folder for the diagrams [RUN/plots]")
      ->type_name("DIR");
  command->add_flag(
      "--csv", request->csv,
      "Print a table of all frames instead; stages of different frames run at the same time, "
      "so that seconds_total may be less than their sum");
  command->add_flag("--overwrite", request->overwrite, "Replace the run's diagrams in the folder");
  add_examples(*command, {"pneuma plot out/pressure_soft", "pneuma plot out/pressure_soft --csv"});
  command->callback([request, &action] { action = [request] { return plot_run(*request); }; });
}

void add_compare_command(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "compare", "Where two runs part: state, pictures, numbers, and a picture of the difference");
  const auto request = std::make_shared<CompareRequest>();
  const auto run_option = [&](const char* name, std::string& folder) {
    command->add_option(name, folder, "Folder of a render, finished or not")
        ->required()
        ->type_name("DIR");
  };
  run_option("A", request->first);
  run_option("B", request->second);
  command->add_option("--frame", request->frame, "The frame to show [the first that differs]")
      ->type_name("N");
  command
      ->add_option(
          "--out", request->out,
          "PNG file of A, B and their difference [out/compare/A_B.png, by the folders' names]")
      ->type_name("FILE");
  command->add_flag("--expect-equal", request->expect_equal,
                    "Exit with 7 when a frame's state or picture differs or is missing");
  add_examples(*command, {"pneuma compare out/pressure_soft stiff",
                          "pneuma compare out/a out/b --frame 60 --out difference.png"});
  command->callback(
      [request, &action] { action = [request] { return compare_run_folders(*request); }; });
}

}  // namespace pneuma::app
