// Measures how fast a scene's pictures are made.
#pragma once

#include <cstdint>
#include <optional>

#include "app/host/budget.h"
#include "app/host/clock.h"
#include "app/picture/run_camera.h"
#include "app/picture/show.h"
#include "app/record/statistics.h"
#include "app/world/replay.h"
#include "render/context/backend.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

/// Frames of the paper: 1/60 s of the scene's time, drawn and encoded as PNG to memory, as
/// `pneuma render` does it: while one is drawn, a second thread steps to the next and a third
/// encodes the one before.
struct FrameTimes {
  std::int64_t frames = 0;
  int width = 0;  // pixels
  int height = 0;
  Spread seconds;  // of whole frames
  // Of the parts of a frame, s: medians, which need not add up to the median of the whole.
  double steps = 0.0;
  double build = 0.0;  // what the renderer is handed
  double draw = 0.0;
  double encode = 0.0;
};

/// The frames that follow the replay's present state, with what `show` says in them. Throws
/// DivergenceError and render::GlError.
FrameTimes measure_frames(Replay& replay, int steps_per_frame, const scenes::Scene& scene,
                          RunCamera& camera, const Show& show, const Budget& budget,
                          std::optional<render::Backend> backend);

}  // namespace pneuma::app
