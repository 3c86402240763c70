// `pneuma plot`: the numbers of a run over its time, as diagrams or as a table.
#pragma once

#include <string>
#include <vector>

#include "app/host/exit_code.h"
#include "app/runs/recorded_run.h"
#include "app/study/diagram.h"

namespace pneuma::app {

struct PlotRequest {
  std::string run;  // a folder
  std::string out;  // a folder; empty: plots in the run's
  bool csv = false;
  bool overwrite = false;  // diagrams that are there
};

struct NamedDiagram {
  std::string name;  // of its files
  Diagram diagram;
};

/// Energy, volume, pressure, gas that comes or goes, penetration, contacts, time of each stage;
/// those with anything to show.
std::vector<NamedDiagram> run_diagrams(const RecordedRun& run);

/// A row per frame: what the diagrams show, with the state's hash.
std::string run_csv(const RecordedRun& run);

/// Writes the diagrams, or prints the table. Throws base::IoError, UsageError and
/// Interrupted.
ExitCode plot_run(const PlotRequest& request);

}  // namespace pneuma::app
