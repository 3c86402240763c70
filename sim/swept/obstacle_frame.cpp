#include "sim/swept/obstacle_frame.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {
namespace {

ObstaclePlace between(const ObstaclePlace& start, const ObstaclePlace& end, double fraction) {
  return {(1.0 - fraction) * start.axes + fraction * end.axes,
          (1.0 - fraction) * start.origin + fraction * end.origin};
}

/// From the world into its own axes.
class OwnAxes {
 public:
  explicit OwnAxes(const ObstaclePlace& place)
      : turn_(mat3x4(place.axes.inverse())), origin_(to_vec4d(place.origin)) {}
  Vec4d operator*(Vec4d point) const { return turn_ * (point - origin_); }

 private:
  Mat3x4 turn_;
  Vec4d origin_;
};

}  // namespace

void ObstacleFrame::set(const ObstaclePlace& start, const ObstaclePlace& end, double from,
                        double to) {
  const double trace = (start.axes.transpose() * end.axes).trace();  // 1 + 2 cos(angle)
  shortening_ = 0.5 * std::sqrt(std::max(0.0, 1.0 + trace));
  start_ = between(start, end, from);
  end_ = between(start, end, to);
}

double ObstacleFrame::look_at(const VertexArray& start, const VertexArray& end,
                              VertexArray& own_start, VertexArray& own_end) const {
  const OwnAxes at_start(start_), at_end(end_);
  const VertexReader from(start), to(end);
  const VertexWriter own_from(own_start), own_to(own_end);
  double way = 0.0;  // squared
  for (int v = 0; v < start.size(); ++v) {
    const Vec4d a = at_start * from[v], e = at_end * to[v];
    own_from.put(v, a);
    own_to.put(v, e);
    way = std::max(way, dot(e - a, e - a));
  }
  return bend_of_way() * std::sqrt(way);
}

Bounds ObstacleFrame::way_of(const Bounds& own) const {
  const Vec3 centre = own.centre(), half = 0.5 * own.size();
  Bounds way;
  for (const ObstaclePlace* place : {&start_, &end_}) {
    const Vec3 middle = *place * centre, around = place->axes.cwiseAbs() * half;
    way.include(Bounds{middle - around, middle + around});
  }
  return way;
}

/// A way is affine in the place of the vertex: the longest begins in a corner.
double ObstacleFrame::longest_way(const Bounds& own) const {
  double longest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 vertex((corner & 1) != 0 ? own.low.x() : own.high.x(),
                      (corner & 2) != 0 ? own.low.y() : own.high.y(),
                      (corner & 4) != 0 ? own.low.z() : own.high.z());
    longest = std::max(longest, (end_ * vertex - start_ * vertex).norm());
  }
  return longest;
}

}  // namespace pneuma::sim
