// What points on surfaces get of sky, floor and other bodies, from the bodies' elements.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "render/light/body_tree.h"
#include "render/light/elements.h"

namespace pneuma::render {

/// Points that are near each other, in columns, so that eight are done at once.
struct Receivers {
  static constexpr std::size_t most = 64;
  using Column = Eigen::Array<float, Eigen::Dynamic, 1, Eigen::ColMajor, most, 1>;

  Eigen::Index count = 0;
  Column x, y, z;     // m
  Column nx, ny, nz;  // unit
  Column sky, floor;  // fraction of the hemisphere that each fills, if nothing stands before it
  // Fractions of the hemisphere that elements take of the light from above and from below, added
  // up; and what they send instead, over pi.
  Column above, below;
  Column red, green, blue;
  // What is left of sky and floor. Bodies lie behind each other by chance, so that what one takes
  // is of what the others leave.
  Column sky_left, floor_left;

  /// For so many points to be added.
  void begin(std::size_t points);
  void add(const Vec3f& position, const Vec3f& normal);
};

/// Adds what the bodies take and send. A body that is far away for its size counts as a ball.
void gather(std::span<const BodyElements> bodies, Receivers& receivers);
/// Likewise, and so does a group of bodies.
void gather(const BodyTree& bodies, Receivers& receivers);

/// What is left at one receiver. Elements send no more than the bodies take.
IndirectLight left_at(const Receivers& receivers, std::size_t number);

}  // namespace pneuma::render
