// Random features in every relation that has made a feature test fail somewhere, and their true
// distance by a method that shares nothing with the tests: enumeration of the faces that can carry
// the nearest points, each a small least-squares problem.
#pragma once

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "sim/collision/feature_tests.h"

namespace pneuma::sim {

/// One to three corners of a vertex, an edge or a triangle.
using Points = std::vector<Vec3>;

struct FeaturePair {
  Points first;
  Points second;
  double reach;
  double tolerance;  // m, for the distance
};

inline Segment segment(const Points& p) { return {p[0], p[1]}; }
inline Corners corners(const Points& p) { return {p[0], p[1], p[2]}; }

/// The feature test that fits the numbers of corners, of which the second is not the smaller.
inline std::optional<Proximity> test_features(const Points& a, const Points& b, double reach) {
  switch (a.size() * 10 + b.size()) {
    case 11:
      return test_vertex_vertex(a[0], b[0], reach);
    case 12:
      return test_vertex_edge(a[0], segment(b), reach);
    case 13:
      return test_vertex_triangle(a[0], corners(b), reach);
    case 22:
      return test_edge_edge(segment(a), segment(b), reach);
    case 23:
      return test_edge_triangle(segment(a), corners(b), reach);
    default:
      return test_triangle_triangle(corners(a), corners(b), reach);
  }
}

/// Distance of the nearest points of the affine hulls of two sets of corners, if those points are
/// convex combinations of the corners; else infinity. x = a0 + A u and y = b0 + B v are nearest
/// where |A u - B v - (b0 - a0)| is least.
inline double distance_of_interiors(std::span<const Vec3> a, std::span<const Vec3> b) {
  const int m = static_cast<int>(a.size()) - 1;
  const int n = static_cast<int>(b.size()) - 1;
  Mat3 columns = Mat3::Zero();  // those left over stay zero and get no weight
  for (int i = 0; i < m; ++i) columns.col(i) = a[at(i + 1)] - a[0];
  for (int i = 0; i < n; ++i) columns.col(m + i) = b[0] - b[at(i + 1)];
  const Vec3 offset = b[0] - a[0];
  if (m + n == 0) return offset.norm();
  const Eigen::ColPivHouseholderQR<Mat3> solver(columns);
  // Without full rank a smaller face attains the same distance.
  if (solver.rank() < m + n) return std::numeric_limits<double>::infinity();
  const Vec3 weights = solver.solve(offset);
  double sum_of_a = 0.0;
  double sum_of_b = 0.0;
  for (int i = 0; i < m + n; ++i) (i < m ? sum_of_a : sum_of_b) += weights[i];
  if (weights.minCoeff() < 0.0 || sum_of_a > 1.0 || sum_of_b > 1.0) {
    return std::numeric_limits<double>::infinity();
  }
  return (columns * weights - offset).norm();
}

/// True distance of two features. Two triangles that pass through each other do so at an edge, so
/// the pair of whole triangles needs no looking at.
inline double reference_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  const auto faces = [](std::span<const Vec3> corners) {
    std::vector<Points> result;
    for (unsigned subset = 1; subset < 1U << corners.size(); ++subset) {
      Points face;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if ((subset >> i & 1U) != 0) face.push_back(corners[i]);
      }
      result.push_back(face);
    }
    return result;
  };
  double least = std::numeric_limits<double>::infinity();
  const auto faces_of_b = faces(b);
  for (const Points& face : faces(a)) {
    for (const Points& other : faces_of_b) {
      if (face.size() + other.size() < 6) {
        least = std::min(least, distance_of_interiors(face, other));
      }
    }
  }
  return least;
}

/// Twice a triangle's area as a share of its longest side squared, 1 for anything else.
inline double sine_of_sliver(const Points& p) {
  if (p.size() < 3) return 1.0;
  const double side = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
  const double area = (p[1] - p[0]).cross(p[2] - p[0]).norm();
  return area > 0.0 ? std::min(1.0, area / (side * side)) : 1e-300;
}

class FeatureSampler {
 public:
  explicit FeatureSampler(unsigned seed) : random_(seed) {}

  static constexpr int relations = 11;

  /// A pair of features of so many corners, in one of the relations of relate().
  FeaturePair sample(std::size_t first_size, std::size_t second_size, int relation) {
    Points a = points(first_size, 1.0);
    Points b = points(second_size, 1.0);
    const double reach = relate(a, b, relation);
    double scale = 0.0;
    for (const Points* points : {&a, &b}) {
      for (const Vec3& p : *points) scale = std::max(scale, p.cwiseAbs().maxCoeff());
    }
    const double sine = std::min(sine_of_sliver(a), sine_of_sliver(b));
    // Distances are differences of coordinates, so they carry a few units in the last place of the
    // largest one: 2^-53 times about 50 operations. The normal of a sliver magnifies them; one
    // thinner than 1e-8 counts as its edges.
    const double tolerance = scale * std::min(5e-15 / sine, 2e-8);
    return {a, b, reach, tolerance};
  }

  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  /// In the cube from -1 to 1.
  Vec3 point() {
    const double x = 2.0 * unit() - 1.0;
    const double y = 2.0 * unit() - 1.0;
    return {x, y, 2.0 * unit() - 1.0};
  }

 private:
  /// Brings the features into a relation and returns the reach to test them with.
  double relate(Points& a, Points& b, int relation) {
    double reach = 1.0;
    switch (relation) {
      case 0:  // anywhere, of the paper's proportions: edges of 1 to 3 units, reach 1
        a = points(a.size(), 1.5);
        b = points(b.size(), 1.5);
        move(b, 3.0 * point());
        break;
      case 1:  // anywhere, reach small beside the features
        reach = std::pow(10.0, -4.0 * unit());
        move(b, 0.5 * point());
        break;
      case 2:  // parallel or coplanar, but for rounding
        make_parallel(a, b);
        break;
      case 3:  // the same with an angle of 1e-12 to 1e-1 between them
        make_parallel(a, b);
        for (Vec3& p : b) p += std::pow(10.0, -12.0 + 11.0 * unit()) * point();
        break;
      case 4:  // touching in a point
        move(b, inside(a) - inside(b));
        reach = unit() < 0.5 ? 1.0 : 1e-6;
        break;
      case 5:  // a feature collapsed onto a line or a point
        collapse(unit() < 0.5 ? a : b);
        if (unit() < 0.3) collapse(a);
        move(b, point());
        break;
      case 6:  // on a coarse grid: exactly coincident, collinear, coplanar, orthogonal
        for (Vec3& p : a) p = grid_point();
        for (Vec3& p : b) p = grid_point();
        reach = std::sqrt(unit() * 4.0);
        break;
      case 7:  // far from the origin, at any size
        reach = place_far_away(a, b);
        break;
      case 8:  // slivers: collapsed but for 1e-16 to 1e-2
        for (Points* points : {&a, &b}) {
          if (unit() < 0.7) collapse(*points);
          for (Vec3& p : *points) p += std::pow(10.0, -16.0 + 14.0 * unit()) * point();
        }
        move(b, point());
        break;
      case 9:  // nearly parallel, and crossing in the middle
        make_parallel(a, b);
        for (Vec3& p : b) p += std::pow(10.0, -12.0 + 11.0 * unit()) * point();
        move(b, inside(a) - inside(b));
        reach = unit() < 0.5 ? 1.0 : 1e-6;
        break;
      case 10:  // slivers right above or through each other
        lay_slivers_together(a, b);
        break;
      default:
        break;
    }
    return reach;
  }

  /// Returns their size.
  double place_far_away(Points& a, Points& b) {
    const double size = std::pow(10.0, -3.0 + 6.0 * unit());
    for (Points* points : {&a, &b}) {
      for (Vec3& p : *points) p *= size;
    }
    const Vec3 origin = std::pow(10.0, 6.0 * unit()) * size * point();
    move(a, origin);
    move(b, origin + size * point());
    return size;
  }

  void lay_slivers_together(Points& a, Points& b) {
    for (Points* points : {&a, &b}) {
      for (std::size_t i = 2; i < points->size(); ++i) {
        (*points)[i] = (*points)[0] + unit() * ((*points)[1] - (*points)[0]) +
                       std::pow(10.0, -12.0 + 12.0 * unit()) * point();
      }
    }
    const Vec3 normal = (b.back() - b.front()).cross(b[b.size() / 2] - b.front());
    const double gap = unit() < 0.5 ? 0.0 : std::pow(10.0, -3.0 * unit());
    const double length = normal.norm();
    move(b, inside(a) - inside(b) + gap / std::max(length, 1e-30) * normal);
  }

  Points points(std::size_t count, double size) {
    Points result(count);
    for (Vec3& p : result) p = size * point();
    return result;
  }

  Vec3 grid_point() {
    std::uniform_int_distribution<int> coordinate(-1, 1);
    const int x = coordinate(random_);
    const int y = coordinate(random_);
    return Vec3(x, y, coordinate(random_));
  }

  static void move(Points& points, const Vec3& by) {
    for (Vec3& p : points) p += by;
  }

  Vec3 inside(const Points& points) {
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (const Vec3& p : points) {
      const double weight = unit();
      sum += weight * p;
      weights += weight;
    }
    return sum / weights;
  }

  /// Of features of different orders the lower one follows the higher one: a triangle along an edge
  /// would be none.
  void make_parallel(Points& a, Points& b) {
    if (b.size() > a.size()) {
      a = parallel_to(b, a.size());
    } else {
      b = parallel_to(a, b.size());
    }
  }

  /// In the plane of a triangle's sides, or along an edge, moved elsewhere.
  Points parallel_to(const Points& a, std::size_t size) {
    const Vec3 along = a.back() - a.front();
    const Vec3 other = a[a.size() / 2] - a.front();
    const Vec3 origin = a.front() + point();
    Points result(size);
    for (Vec3& p : result) {
      const double s = 3.0 * unit() - 1.0;
      const double t = a.size() < 3 ? 0.0 : 3.0 * unit() - 1.0;
      p = origin + s * along + t * other;
    }
    return result;
  }

  void collapse(Points& points) {
    if (points.size() == 3 && unit() < 0.5) {
      points[2] = points[0] + (2.0 * unit() - 0.5) * (points[1] - points[0]);
      return;
    }
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (i == 1 || unit() < 0.7) points[i] = points[0];
    }
  }

  std::mt19937 random_;
};

}  // namespace pneuma::sim
