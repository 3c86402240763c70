// Runs many runs of a sweep at once.
#pragma once

#include <cstdint>
#include <filesystem>

#include "app/sweep/sweep_journal.h"
#include "app/terminal/progress.h"

namespace pneuma::app {

/// Runs first..last, both among them.
struct RunRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// Makes those rows of the range that the journal lacks, on so many threads, one run on each.
/// Throws base::IoError when a row cannot be written, and Interrupted; the rows so far are in the
/// journal.
void run_sweep(const Sweep& sweep, const RunRange& range, int threads,
               const std::filesystem::path& folder, SweepJournal& journal, Progress& progress);

}  // namespace pneuma::app
