// Pictures of a finished run that were lost, drawn again.
#pragma once

#include "app/render/draw_frames.h"

namespace pneuma::app {

/// Steps the simulation from its start through the frames of log.lost() and draws those alone.
/// Throws DivergenceError, Interrupted and base::IoError, the last also when a state is another
/// than the record says: then nothing is drawn from there on.
void redraw_lost(Simulation& simulation, const FrameOutput& output, Progress& progress);

}  // namespace pneuma::app
