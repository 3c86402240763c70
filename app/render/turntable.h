// One moment of a run, seen from all around.
#pragma once

#include "app/picture/build_frame.h"
#include "app/render/log/run_folder.h"
#include "app/terminal/progress.h"
#include "app/world/simulation.h"
#include "render/renderer.h"

namespace pneuma::app {

inline constexpr int max_turntable = 3600;  // pictures: ten to a degree

/// A folder of their own for a turntable's pictures: turntable/NAME_00000.png and so on.
RunFolder turntable_folder(const RunFolder& run);

/// Draws the present state `pictures` times, each time with the camera turned by as much again
/// about the vertical through its target. Throws base::IoError, Interrupted.
void draw_turntable(const Simulation& simulation, const render::Camera& camera,
                    const FrameBuilder& builder, const Show& show, int pictures,
                    const RunFolder& folder, render::Renderer& renderer, Progress& progress);

}  // namespace pneuma::app
