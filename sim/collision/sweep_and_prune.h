// Which of many bounding spheres, or boxes, overlap (section 5.1), by sort and sweep.
#pragma once

#include <span>
#include <vector>

#include "sim/collision/packed_spheres.h"
#include "sim/mesh/packed_bounds.h"

namespace pneuma::sim {

/// All overlapping pairs of spheres, in ascending order. Keeps its memory between calls, so that
/// nothing is allocated once the numbers of spheres and pairs have peaked. A sphere that is not
/// finite overlaps none. 0.1 ms for 1,000 bodies that fill a cube loosely, 5 ms for 10,000.
class SweepAndPrune {
 public:
  /// Fills `pairs`, whose old content is dropped.
  void find(std::span<const BoundingSphere> spheres, std::vector<BodyPair>& pairs);
  /// The same of boxes along the axes, which touch if they share a point.
  void find(std::span<const Bounds> boxes, std::vector<BodyPair>& pairs);

 private:
  struct Entry {
    double low;  // where the shape begins and ends along the axis of the sweep
    double high;
    int index;
  };

  template <class Shape, class Packed>
  void find(std::span<const Shape> shapes, Packed& packed, std::vector<BodyPair>& pairs);
  template <class Shape, class Packed>
  void line_up(std::span<const Shape> shapes, Packed& packed);
  template <class Shape, class Packed>
  void compare_with_next(std::size_t i, const Shape& shape, const Packed& packed,
                         std::vector<BodyPair>& pairs) const;
  void sort_by(int BodyPair::*body, std::size_t bodies, std::vector<BodyPair>& pairs);

  std::vector<Entry> entries_;  // in the order in which they begin
  PackedSpheres spheres_;       // in that order
  PackedBounds boxes_;          // or these
  std::vector<int> starts_;     // of the pairs of each body
  std::vector<BodyPair> sorted_;
};

}  // namespace pneuma::sim
