// How well a soft body kept its shape.
#pragma once

#include "sim/world/soft_body.h"

namespace pneuma::app {

/// The max distance of a vertex from where it is in the rest shape, over the diagonal of the rest
/// shape's bounding box. The rest shape is turned and moved to where the sum of the squared
/// distances is minimal (Kabsch, A solution for the best rotation to relate two sets of vectors,
/// 1976), but not mirrored.
double shape_deviation(const sim::SoftBody& body);

}  // namespace pneuma::app
