// An obstacle that is moved, seen in its own axes: there neither its shape nor its bounding
// hierarchy ever changes, however many triangles it has.
//
// Its vertices move along straight lines through a step, x(s) = o(s) + A(s) X with A(s) = (1 - s)
// A0 + s A1. Between two rotations by an angle a, A(s) shortens lengths to cos(a / 2) at least.
// Another point, on a straight line from y0 to y1, goes in the obstacle's axes from a = A0^-1 (y0 -
// o0) to e = A1^-1 (y1 - o1). Between them it leaves the line through both by
//
//   A(s)^-1 ((1 - s) A0 a + s A1 e) - (1 - s) a - s e = s (1 - s) A(s)^-1 (A1 - A0) (e - a),
//
// which is no longer than |A1 - A0| |e - a| / (4 cos(a / 2)).
#pragma once

#include "sim/mesh/measure.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

/// Where an obstacle's own axes lie.
struct ObstaclePlace {
  Mat3 axes = Mat3::Identity();
  Vec3 origin = Vec3::Zero();  // m

  Vec3 operator*(const Vec3& own) const { return origin + axes * own; }
};

class ObstacleFrame {
 public:
  /// Of the part of a step from one fraction of it to another: at its start and at its end the axes
  /// are rotations.
  void set(const ObstaclePlace& start, const ObstaclePlace& end, double from, double to);

  const ObstaclePlace& start() const { return start_; }
  const ObstaclePlace& end() const { return end_; }
  /// Whether a step turns it by so little that its own axes help.
  bool is_of_use() const { return shortening_ > 0.9; }

  /// Of another surface, at the start and at the end, m. Returns by how much its vertices leave the
  /// straight lines between them at most.
  double look_at(const VertexArray& start, const VertexArray& end, VertexArray& own_start,
                 VertexArray& own_end) const;
  /// m, which may be that long in the world.
  double own_length(double length) const { return length / shortening_; }
  /// m, by which a way changes at most, its bend included, when its end does by so much (m).
  double own_change(double of_end) const { return (1.0 + bend_of_way()) * own_length(of_end); }
  /// About the way of what lies within these bounds in its own axes.
  Bounds way_of(const Bounds& own) const;
  /// m, of a vertex within these bounds, at most.
  double longest_way(const Bounds& own) const;

 private:
  /// Of the length of a way in its axes.
  double bend_of_way() const { return (end_.axes - start_.axes).norm() / (4.0 * shortening_); }

  ObstaclePlace start_, end_;
  double shortening_ = 1.0;
};

}  // namespace pneuma::sim
