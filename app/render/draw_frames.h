// The loop from the world to the files of its frames.
#pragma once

#include <cstdint>

#include "app/picture/build_frame.h"
#include "app/picture/field_scale.h"
#include "app/picture/run_camera.h"
#include "app/render/log/run_log.h"
#include "app/terminal/progress.h"
#include "app/world/simulation.h"
#include "render/renderer.h"

namespace pneuma::app {

/// What becomes of a frame's state.
struct FrameOutput {
  const FrameBuilder& builder;
  RunCamera& camera;
  FieldScale& fields;
  const Pictures& pictures;
  render::Renderer& renderer;
  RunLog& log;
};

/// Advances the simulation to frame `last` and draws all from log.next_frame() on: while one is
/// drawn, a second thread makes the next and a third encodes and writes the one before. Throws
/// DivergenceError, Interrupted and base::IoError; what is on disk then is whole.
void draw_frames(Simulation& simulation, std::int64_t last, const FrameOutput& output,
                 Progress& progress);

}  // namespace pneuma::app
