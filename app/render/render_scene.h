// Scene to frames: the main job.
#pragma once

#include "app/host/exit_code.h"
#include "app/render/render_request.h"

namespace pneuma::app {

/// Draws the frames of a scene into a folder, with a record beside them; prints the folder, the
/// contact sheet and the video to standard output. Throws what app/host/errors.h lists.
ExitCode render_scene(const RenderRequest& request);

}  // namespace pneuma::app
