// Tells a frame that can be drawn from one that cannot.
#pragma once

#include "render/frame/frame.h"

namespace pneuma::render {

/// Throws std::invalid_argument naming what is wrong, with its index and value: a number that is
/// not finite or out of its range, arrays whose sizes do not match, an index beyond the vertices.
void check_frame(const Frame& frame);

}  // namespace pneuma::render
