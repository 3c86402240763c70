// Bodies that touch, apart from those that are in each other, and those that are crushed by them.
#pragma once

#include <string>
#include <vector>

#include "sim/inspect/crossings.h"
#include "sim/mesh/measure.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Around a body, numbered as in sim::closed_surfaces().
sim::Bounds body_bounds(const sim::World& world, int body);

/// m, along x, y or z.
double least_extent(const sim::World& world, int body);

/// m, up to which two bodies touch. Contacts by impulses are resolved after the motion: what rests
/// on another body was moved into it by g dt^2 before, and in a pile by more. Twice that is
/// allowed, of thin bodies a twentieth of their extent at most; and a rounding of positions.
double touch_depth(const sim::World& world, int first, int second);

/// Whether the two are in each other by more than a touch.
bool is_beyond_touch(const sim::World& world, int first, int second);

/// The pairs of different bodies among the crossings that are in each other by more than a touch.
std::vector<sim::CrossingPair> crossings_beyond_touch(const sim::World& world,
                                                      const sim::Crossings& crossings);

/// "ball is crushed between left and right, to 3 of its 113 m^3": the body of that name, or another
/// if `any`, has less than half of its volume at rest, and lies between one that is moved and one
/// that does not give way. Empty where there is none.
std::string crushed_between(const sim::World& world, const std::string& name, bool any);

}  // namespace pneuma::app
