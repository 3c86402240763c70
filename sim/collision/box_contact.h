// Where two boxes touch: the points that an impulse needs (ERRATA row 18).
#pragma once

#include <array>
#include <optional>
#include <span>

#include "sim/collision/oriented_box.h"

namespace pneuma::sim {

struct BoxContactPoint {
  Vec3 point = Vec3::Zero();  // m
  double depth = 0.0;  // m the boxes must move apart along the normal to part here; < 0: apart
};

/// One to eight points that share a normal.
struct BoxContact {
  static constexpr int max_points = 8;

  Vec3 normal = Vec3::Zero();  // unit; the impulse on the first box is along +normal
  double depth = 0.0;          // m; moving either box by more than this along the normal parts them
  int count = 0;
  std::array<BoxContactPoint, max_points> all;

  std::span<const BoxContactPoint> points() const {
    return std::span(all).first(static_cast<std::size_t>(count));
  }
};

/// The points of boxes that overlap or touch; none when they are apart.
std::optional<BoxContact> find_box_contact(const OrientedBox& first, const OrientedBox& second);

/// Also of boxes that are up to `reach` (m) apart, and the points of theirs that are (depth < 0);
/// none of boxes that are apart and face each other with no part of a face, or with a strip of it
/// that is narrower than 5e-5 of the shortest half side of both.
std::optional<BoxContact> find_box_contact_within(double reach, const OrientedBox& first,
                                                  const OrientedBox& second);

}  // namespace pneuma::sim
