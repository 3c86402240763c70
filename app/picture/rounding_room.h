// How far the drawn surfaces of coarse bodies may bulge to look round.
#pragma once

#include <vector>

#include "render/frame/frame.h"

namespace pneuma::app {

/// Sets the room of each smooth mesh of up to 2,000 triangles: half of what is free between a
/// triangle and the other bodies, so that bodies that do not cross are not drawn crossing. A finer
/// mesh is round enough as it is. Parts of one body are not kept apart.
void set_rounding_room(std::vector<render::Mesh>& meshes);

}  // namespace pneuma::app
