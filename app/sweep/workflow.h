// A sweep as a Snakemake workflow: the same jobs in chunks, here or on a cluster.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/sweep/frame_chunks.h"
#include "app/sweep/run_sweep.h"

namespace pneuma::app {

/// What runs are expected to take, from a few that were run.
struct CostEstimate {
  std::vector<double> seconds;  // of each run
  double measured = 0.0;        // s that measuring took
  int runs = 0;                 // that were run for it

  double total() const;
};

/// Runs a few runs, spread over the sweep, for some seconds; the others take what their steps and
/// vertices say. Of a scene that cannot be loaded: nothing. Throws Interrupted.
CostEstimate estimate_cost(const Sweep& sweep, Progress& progress);

/// Neighbouring runs of together at most so many seconds; at least one in each.
std::vector<RunRange> make_chunks(const std::vector<double>& seconds, double most_seconds);

struct Workflow {
  std::vector<RunRange> chunks;
  std::vector<FrameChunk> frames;  // of a sweep of whole films; else pictures come with the runs
  double seconds_per_chunk = 60.0;
};

/// The Snakefile. `program` and the sweep's file are absolute, so that it can be run from its
/// folder.
std::string snakefile(const Sweep& sweep, const std::string& program, const Workflow& workflow);

}  // namespace pneuma::app
