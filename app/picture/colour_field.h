// Strain, velocity or pressure as colours of the surfaces, with their legend.
#pragma once

#include <vector>

#include "app/picture/show.h"
#include "render/frame/frame.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Of `part` 0..1: matplotlib's viridis, whose steps look alike and which people with colour
/// blindness can read (van der Walt and Smith, 2015).
render::Colour viridis(double part);

/// Values of each vertex, soft bodies first, then boxes; empty where a body has none: boxes have
/// velocities only.
std::vector<std::vector<double>> field_values(const sim::World& world, ColourField field);

/// Of all bodies and vertices; 0 where there is none.
double greatest(const std::vector<std::vector<double>>& values);

/// 1, 2 or 5 times a power of ten: the first that is not below `value`; 1 for 0.
double round_end(double value);

/// Colours the frame's meshes, which are those of the world's bodies and then of its joints, and
/// adds the legend. What has no values becomes grey.
void add_field(const sim::World& world, const Show& show, render::Frame& frame);

}  // namespace pneuma::app
