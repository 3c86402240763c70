// Random pairs of boxes in every relation that matters, and references that share nothing with the
// separating axis test: overlap by clipping every edge of each box by the other, extents by looking
// at every corner.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/collision/oriented_box.h"

namespace pneuma::sim {

/// The rotation about a unit vector.
inline Mat3 turn(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

class BoxRandom {
 public:
  explicit BoxRandom(unsigned seed) : engine_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(engine_); }
  double between(double low, double high) { return low + (high - low) * unit(); }
  Vec3 point() {
    const double x = between(-1.0, 1.0);
    const double y = between(-1.0, 1.0);
    return {x, y, between(-1.0, 1.0)};
  }
  Vec3 direction() {
    std::normal_distribution<double> normal;
    const double x = normal(engine_);
    const double y = normal(engine_);
    return Vec3(x, y, normal(engine_)).normalized();
  }
  Mat3 rotation() { return turn(direction(), between(0.0, std::numbers::pi)); }
  OrientedBox box() {
    OrientedBox box;
    box.centre = 1.5 * point();
    box.axes = rotation();
    for (int k = 0; k < 3; ++k) box.half[k] = 0.2 * std::pow(10.0, unit());
    return box;
  }

 private:
  std::mt19937 engine_;
};

struct BoxPair {
  OrientedBox first;
  OrientedBox second;
};

constexpr int box_relations = 5;

inline BoxPair sample_boxes(BoxRandom& random, int relation) {
  BoxPair pair{random.box(), random.box()};
  auto& [first, second] = pair;
  switch (relation) {
    case 0:  // anyhow
      break;
    case 1:  // parallel, the axes perhaps exchanged
      second.axes = first.axes;
      if (random.unit() < 0.5) second.axes.col(0).swap(second.axes.col(2));
      break;
    case 2:  // turned about an axis they share
      second.axes = turn(first.axes.col(1), random.between(0.0, 3.0)) * first.axes;
      break;
    case 3:  // nearly parallel
      second.axes =
          turn(random.direction(), std::pow(10.0, random.between(-12.0, -1.0))) * first.axes;
      break;
    default: {  // stacked, a little into each other
      second.axes = turn(random.direction(), 0.01 * random.unit()) * first.axes;
      const double overlap = std::pow(10.0, random.between(-6.0, -1.0));
      const Vec3 beside{random.between(-0.3, 0.3), random.between(-0.3, 0.3), 0.0};
      const double height = first.half.z() + second.half.z() - overlap;
      second.centre = first.centre + first.axes * (beside + height * Vec3::UnitZ());
      break;
    }
  }
  return pair;
}

/// Whether any part of the segment is in the box, by clipping it at the six faces.
inline bool segment_meets_box(const Vec3& p, const Vec3& q, const OrientedBox& box) {
  double enter = 0.0;
  double leave = 1.0;
  for (int k = 0; k < 3; ++k) {
    const double from = (p - box.centre).dot(box.axes.col(k));
    const double along = (q - p).dot(box.axes.col(k));
    if (std::abs(along) < 1e-14) {
      if (std::abs(from) > box.half[k]) return false;
      continue;
    }
    const double t = (-box.half[k] - from) / along;
    const double u = (box.half[k] - from) / along;
    enter = std::max(enter, std::min(t, u));
    leave = std::min(leave, std::max(t, u));
  }
  return enter <= leave;
}

/// What two boxes share is a polyhedron, each of whose corners is a corner of one box in the other
/// or an edge of one through a face of the other. So they overlap when an edge of either meets the
/// other box.
inline bool reference_overlap(const OrientedBox& a, const OrientedBox& b) {
  const auto edge_meets = [](const OrientedBox& edges, const OrientedBox& box) {
    for (int i = 0; i < 8; ++i) {
      for (const int bit : {1, 2, 4}) {
        if ((i & bit) != 0) continue;
        if (segment_meets_box(edges.corner(i), edges.corner(i | bit), box)) return true;
      }
    }
    return false;
  };
  return edge_meets(a, b) || edge_meets(b, a);
}

inline OrientedBox moved(OrientedBox box, const Vec3& by) {
  box.centre += by;
  return box;
}

inline OrientedBox grown(OrientedBox box, double by) {
  box.half.array() += by;
  return box;
}

// Coordinates and sizes are below 10; boxes this near to touching may fall either way by rounding.
inline constexpr double rounding = 1e-13;

/// Half the extent of a box in a direction, from its corners.
inline double extent(const OrientedBox& box, const Vec3& direction) {
  double farthest = 0.0;
  for (int i = 0; i < 8; ++i) {
    farthest = std::max(farthest, (box.corner(i) - box.centre).dot(direction));
  }
  return farthest;
}

}  // namespace pneuma::sim
