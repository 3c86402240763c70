// The loop from the world to the files of its frames.
#pragma once

#include <cstdint>

#include "app/build_frame.h"
#include "app/journal.h"
#include "app/progress.h"
#include "app/run_folder.h"
#include "app/simulation.h"
#include "render/renderer.h"

namespace pneuma::app {

/// What becomes of a frame's state.
struct FrameOutput {
  const FrameBuilder& builder;
  const Pictures& pictures;
  render::Renderer& renderer;
  const RunFolder& folder;
  Journal& journal;
};

/// Advances the simulation to frame `last` and draws all frames from `next` on: while one is drawn,
/// a second thread steps to the next and a third encodes and writes the one before. After each, the
/// journal has its line and the state file its state, in this order: whatever the moment of a kill,
/// the state belongs to a frame that the journal knows. Throws DivergenceError, Interrupted and
/// render::IoError; what is on disk then is whole.
void draw_frames(Simulation& simulation, std::int64_t next, std::int64_t last,
                 const FrameOutput& output, Progress& progress);

}  // namespace pneuma::app
