// Long renders of a sweep in parts: some frames of one run each.
//
// A part is simulated again from the start of its run and not continued from a state: a state at
// its first frame exists only when a run ahead has come there, which takes as long, so that no part
// would begin to draw earlier; and its processor time is small beside that of drawing, which
// `pneuma sweep --snakemake` measures and says.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/sweep/sweep.h"
#include "app/sweep/sweep_journal.h"

namespace pneuma::app {

/// Frames first..last of a run, both among them.
struct FrameChunk {
  std::int64_t run = 0;
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// "RUN:FIRST-LAST". Throws UsageError, also when the sweep has no such run.
FrameChunk parse_frame_chunk(const std::string& text, const Sweep& sweep);

/// Draws the frames into pictures/run_RUN/FIRST-LAST. Of a run that does not come to its end there
/// are no pictures, and its run.json says why. Throws as render_run does.
void draw_frame_chunk(const Sweep& sweep, const FrameChunk& chunk,
                      const std::filesystem::path& folder);

/// Puts the pictures of all parts of a run beside each other, where an undivided run has them.
/// Throws base::IoError.
void join_frame_chunks(const SweepRows& rows, const std::filesystem::path& folder);

/// What drawing takes, s.
struct DrawingCost {
  double start = 0.0;  // of a process until its first frame, without simulating
  double frame = 0.0;
};

/// Draws some frames of a run twice over in a folder of its own below `folder`. Throws as
/// render_run does.
DrawingCost measure_drawing(const Sweep& sweep, const SweepRun& run,
                            const std::filesystem::path& folder);

/// Parts of about so many seconds for all frames of each run. `simulation`: seconds of each run; of
/// a run without, which cannot be loaded, there are none.
std::vector<FrameChunk> make_frame_chunks(const Sweep& sweep, const std::vector<double>& simulation,
                                          const DrawingCost& drawing, double most_seconds);

/// s that the parts spend on simulating what an undivided run simulates once.
double simulated_again(const std::vector<FrameChunk>& chunks, const Sweep& sweep,
                       const std::vector<double>& simulation);

}  // namespace pneuma::app
