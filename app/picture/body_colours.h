// Colours over a body's rest shape, so that they move with the material.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/frame/frame.h"
#include "sim/mesh/triangle_mesh.h"

namespace pneuma::app {

/// One colour per vertex. `colours` are one to three "#rrggbb": one is plain, two run along `axis`,
/// three belong to the body's x, y and z, as on the cubes of figure 6.5 and the gallery.
std::vector<render::Colour> body_colours(std::span<const sim::Vec3> vertices,
                                         std::span<const std::string> colours,
                                         const sim::Vec3& axis);

}  // namespace pneuma::app
