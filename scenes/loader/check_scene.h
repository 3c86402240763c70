// What no single key can tell.
#pragma once

#include <vector>

#include "scenes/loader/reader.h"
#include "scenes/loader/report.h"
#include "scenes/loader/scene.h"

namespace pneuma::scenes {

/// Checks across keys, and the limits. `reader` has read the scene; `headers` are the places of the
/// bodies' [[body]] lines.
void check_scene(const Scene& scene, const Reader& reader, const std::vector<Origin>& headers,
                 Report& report);

}  // namespace pneuma::scenes
