// Whether valves and springs name bodies that can be their ends.
#pragma once

#include "scenes/loader/reader.h"
#include "scenes/loader/report.h"
#include "scenes/loader/scene.h"

namespace pneuma::scenes {

/// What the scene alone tells of them: which vertices they are fixed to, only its world does.
void check_joints(const Scene& scene, const Reader& reader, Report& report);

}  // namespace pneuma::scenes
