#include "sim/inspect/overlap.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "sim/collision/bounding_sphere.h"
#include "sim/collision/separating_axis.h"
#include "sim/inspect/solid.h"

namespace pneuma::sim {
namespace {

/// Searches for the point of two solids where the sum of the depths in both is greatest.
class DepthSearch {
 public:
  /// The search ends at the first point that is deeper than `enough`.
  DepthSearch(const Solid& first, const Solid& second, double enough)
      : first_(first), second_(second), enough_(enough) {}

  double run() {
    const Bounds in_first = common_part(first_.axes()), in_second = common_part(second_.axes());
    if (is_empty(in_first) || is_empty(in_second)) return 0.0;
    look_at_surface(first_, second_);
    look_at_surface(second_, first_);
    look_at_lattice(first_.axes(), in_first);
    look_at_lattice(second_.axes(), in_second);
    if (depth_ > 0.0) climb(0.5 * std::min(in_first.size().norm(), in_second.size().norm()));
    return depth_;
  }

 private:
  static bool is_empty(const Bounds& box) {
    return !(box.low.array() < box.high.array()).all();  // also of what is not finite
  }

  /// A box along the axes, in coordinates along them, about all points that may be in both.
  Bounds common_part(const Mat3& axes) const {
    const Bounds a = first_.bounds_along(axes), b = second_.bounds_along(axes);
    return {a.low.cwiseMax(b.low), a.high.cwiseMin(b.high)};
  }

  /// What is deeper by no more than the rounding of a distance from a surface is no deeper.
  bool take(const Vec3& point, double depth) {
    constexpr double rounding = 1e-12;
    if (!(depth > depth_ * (1.0 + rounding))) return false;
    depth_ = depth;
    place_ = point;
    return true;
  }

  bool is_enough() const { return depth_ > enough_; }

  bool look(const Vec3& point) {
    if (is_enough()) return false;
    const auto in_first = first_.find_depth(point);
    if (!in_first) return false;
    const auto in_second = second_.find_depth(point);
    return in_second && take(point, in_first->depth + in_second->depth);
  }

  void look_at_surface(const Solid& solid, const Solid& other) {
    solid.sample_surface(other, [&](const Vec3& point) {
      if (is_enough()) return;
      if (const auto inside = other.find_depth(point)) take(point, inside->depth);
    });
  }

  void look_at_lattice(const Mat3& axes, const Bounds& box) {
    constexpr int side = 5;  // odd: the middle is among the points
    for (int i = 0; i < side * side * side; ++i) {
      const Vec3 cell(i % side + 0.5, i / side % side + 0.5, i / (side * side) + 0.5);
      look(axes * (box.low + cell.cwiseProduct(box.size()) / side));
    }
  }

  // The sum is a concave function in convex bodies, with creases where the nearest part of a
  // surface changes. So the ways up are tried: away from both surfaces, from one along the other's
  // (which follows a crease), and along the bodies' own axes and between them, by steps that shrink
  // when none leads up.
  void climb(double step) {
    while (step > 1e-3 * depth_ && !is_enough()) {
      const Vec3 from = place_;
      bool higher = false;
      for (const Vec3& way : ways_up(from)) higher |= look(from + step * way);
      if (!higher) step *= 0.5;
    }
  }

  std::vector<Vec3> ways_up(const Vec3& point) const {
    std::vector<Vec3> ways;
    const auto add = [&](const Vec3& way) {
      if (way.squaredNorm() > 1e-12) ways.push_back(way.normalized());
    };
    for (const Mat3& axes : {first_.axes(), second_.axes()}) {
      for (int k = 0; k < 3; ++k) {
        add(axes.col(k));
        add(-axes.col(k));
      }
      for (int corner = 0; corner < 8; ++corner) {
        const auto sign = [&](int k) { return (corner >> k & 1) != 0 ? 1.0 : -1.0; };
        add(axes * Vec3(sign(0), sign(1), sign(2)));
      }
    }
    const auto in_first = first_.find_depth(point), in_second = second_.find_depth(point);
    const Vec3 u = in_first ? in_first->inward : Vec3::Zero();
    const Vec3 v = in_second ? in_second->inward : Vec3::Zero();
    add(u);
    add(v);
    add(u + v);
    add(u - u.dot(v) * v);
    add(v - u.dot(v) * u);
    return ways;
  }

  const Solid& first_;
  const Solid& second_;
  const double enough_;
  double depth_ = 0.0;
  Vec3 place_ = Vec3::Zero();
};

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A depth beyond `enough` is any that is found first.
double depth_of_pair(const Solid& first, const Solid& second, double enough = infinity) {
  if (first.box() != nullptr && second.box() != nullptr) {
    const auto overlap = find_min_overlap(*first.box(), *second.box());
    return overlap ? overlap->overlap : 0.0;
  }
  return DepthSearch(first, second, enough).run();
}

Solid solid_of(const World& world, int body) {
  const std::size_t soft = world.soft.size();
  return at(body) < soft ? Solid(world.soft[at(body)]) : Solid(world.rigid[at(body) - soft]);
}

}  // namespace

double overlap_depth(const World& world, int first, int second) {
  return depth_of_pair(solid_of(world, first), solid_of(world, second));
}

bool overlap_deeper_than(const World& world, int first, int second, double depth) {
  return depth_of_pair(solid_of(world, first), solid_of(world, second), depth) > depth;
}

std::vector<Overlap> overlaps(const World& world) {
  return overlaps(world, [](int, int) { return infinity; });
}

std::vector<Overlap> overlaps(const World& world, const std::function<double(int, int)>& enough) {
  std::vector<Solid> solids;
  for (const SoftBody& body : world.soft) solids.emplace_back(body);
  for (const RigidBox& box : world.rigid) solids.emplace_back(box);
  std::vector<Bounds> bounds;
  for (const Solid& solid : solids) bounds.push_back(solid.bounds_along(Mat3::Identity()));

  std::vector<Overlap> result;
  const auto add = [&](int first, int second, double depth) {
    if (depth > 0.0) result.push_back({first, second, depth});
  };
  const int count = static_cast<int>(solids.size());
  for (int i = 0; i < count; ++i) {
    const bool kinematic = is_kinematic(world, i);
    if (world.settings.ground && !kinematic) add(i, ground_body, -bounds[at(i)].low.z());
    for (int j = i + 1; j < count; ++j) {
      if (kinematic && is_kinematic(world, j)) continue;
      if (!overlap(bounds[at(i)], bounds[at(j)])) continue;
      add(i, j, depth_of_pair(solids[at(i)], solids[at(j)], enough(i, j)));
    }
  }
  return result;
}

}  // namespace pneuma::sim
