#include "sim/base/exact.h"

#include <algorithm>
#include <utility>

namespace pneuma::base {
namespace {

__extension__ using Wide = __int128;

int sign(Wide value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

GridPoint minus(const GridPoint& a, const GridPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Two products of differences below 2^31 are below 2^63.
GridPoint cross(const GridPoint& a, const GridPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Wide dot(const GridPoint& a, const GridPoint& b) {
  return Wide{a[0]} * b[0] + Wide{a[1]} * b[1] + Wide{a[2]} * b[2];
}

/// The two axes on which a plane is seen best: without the largest component of its normal.
std::array<std::size_t, 2> best_axes(const GridPoint& normal) {
  const auto size = [&](std::size_t i) { return normal[i] < 0 ? -normal[i] : normal[i]; };
  if (size(0) >= size(1) && size(0) >= size(2)) return {1, 2};
  if (size(1) >= size(2)) return {2, 0};
  return {0, 1};
}

/// Points of one plane seen along one axis.
class Flat {
 public:
  explicit Flat(const GridPoint& normal) : axes_(best_axes(normal)) {}

  int turn(const GridPoint& a, const GridPoint& b, const GridPoint& c) const {
    const auto [x, y] = axes_;
    return sign(Wide{b[x] - a[x]} * (c[y] - a[y]) - Wide{b[y] - a[y]} * (c[x] - a[x]));
  }

  bool segments_meet(const GridPoint& a, const GridPoint& b, const GridPoint& c,
                     const GridPoint& d) const {
    const int c_side = turn(a, b, c), d_side = turn(a, b, d);
    const int a_side = turn(c, d, a), b_side = turn(c, d, b);
    if (c_side == 0 && d_side == 0 && a_side == 0 && b_side == 0) return overlap(a, b, c, d);
    return c_side * d_side <= 0 && a_side * b_side <= 0;
  }

  bool inside(const GridPoint& p, const GridPoint& a, const GridPoint& b,
              const GridPoint& c) const {
    const int ab = turn(a, b, p), bc = turn(b, c, p), ca = turn(c, a, p);
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  }

 private:
  /// Of segments on one line: whether they do on each axis.
  bool overlap(const GridPoint& a, const GridPoint& b, const GridPoint& c,
               const GridPoint& d) const {
    return std::all_of(axes_.begin(), axes_.end(), [&](std::size_t axis) {
      const auto [low, high] = std::minmax(a[axis], b[axis]);
      return std::max(c[axis], d[axis]) >= low && std::min(c[axis], d[axis]) <= high;
    });
  }

  std::array<std::size_t, 2> axes_;
};

bool meet_in_plane(const GridPoint& p, const GridPoint& q, const GridPoint& a, const GridPoint& b,
                   const GridPoint& c) {
  const Flat flat(cross(minus(b, a), minus(c, a)));
  return flat.inside(p, a, b, c) || flat.segments_meet(p, q, a, b) ||
         flat.segments_meet(p, q, b, c) || flat.segments_meet(p, q, c, a);
}

}  // namespace

int side_of_plane(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  return -sign(dot(cross(minus(b, a), minus(c, a)), minus(d, a)));
}

bool on_one_line(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return cross(minus(b, a), minus(c, a)) == GridPoint{0, 0, 0};
}

bool segment_meets_triangle(const GridPoint& p, const GridPoint& q, const GridPoint& a,
                            const GridPoint& b, const GridPoint& c) {
  const int p_side = side_of_plane(a, b, c, p), q_side = side_of_plane(a, b, c, q);
  if (p_side == 0 && q_side == 0) return meet_in_plane(p, q, a, b, c);
  if (p_side * q_side > 0) return false;
  // The line p q passes the triangle's sides all on the same side of them.
  const int ab = side_of_plane(p, q, a, b);
  const int bc = side_of_plane(p, q, b, c);
  const int ca = side_of_plane(p, q, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

bool same_side_of_edge(const GridPoint& a, const GridPoint& b, const GridPoint& c,
                       const GridPoint& d) {
  const Flat flat(cross(minus(b, a), minus(c, a)));
  return flat.turn(a, b, c) * flat.turn(a, b, d) > 0;
}

}  // namespace pneuma::base
