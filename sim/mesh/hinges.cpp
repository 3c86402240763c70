#include "sim/mesh/hinges.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/measure.h"

namespace pneuma::sim {
namespace {

/// The vertices across each edge.
std::vector<HingeTable::Corners> find_corners(const MeshTopology& topology) {
  std::vector<HingeTable::Corners> corners;
  for (const auto& [a, b] : topology.edges()) corners.push_back({a, b, a, b});
  for (int t = 0; t < topology.triangle_count(); ++t) {
    const Triangle& triangle = topology.triangles()[at(t)];
    for (std::size_t i = 0; i < 3; ++i) {
      HingeTable::Corners& hinge = corners[at(topology.triangle_edges()[at(t)][i])];
      hinge[hinge[0] == triangle[i] ? 2 : 3] = triangle[(i + 2) % 3];
    }
  }
  return corners;
}

struct Shape {
  double length = 0.0;
  std::array<double, 2> areas = {};
  double area() const { return areas[0] + areas[1]; }
  double min_height() const { return 2.0 * std::min(areas[0], areas[1]) / length; }
};

Shape shape_of(const HingeTable::Corners& hinge, const VertexArray& x) {
  const Vec3 a = x[hinge[0]], b = x[hinge[1]];
  const double first = area_vector(a, b, x[hinge[2]]).norm();
  const double second = area_vector(b, a, x[hinge[3]]).norm();
  return {(b - a).norm(), {first, second}};
}

}  // namespace

HingeAngle hinge_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 first = area_vector(a, b, c).normalized(), second = area_vector(b, a, d).normalized();
  return {first.dot(second), first.cross(second).dot((b - a).normalized())};
}

HingeTable make_hinges(const MeshTopology& topology, const VertexArray& rest_positions) {
  HingeTable table;
  table.corners = find_corners(topology);
  double heights = 0.0;
  std::vector<Shape> shapes;
  for (const HingeTable::Corners& hinge : table.corners) {
    shapes.push_back(shape_of(hinge, rest_positions));
    heights += shapes.back().area() / shapes.back().length;  // the mean of the two
  }
  const double sliver =
      HingeTable::sliver_height * heights / static_cast<double>(table.corners.size());
  for (std::size_t e = 0; e < table.corners.size(); ++e) {
    const auto& [a, b, c, d] = table.corners[e];
    const Shape& shape = shapes[e];
    const bool bends = c != d && shape.min_height() > 0.0;
    const double softened = std::pow(std::min(1.0, shape.min_height() / sliver), 3);
    table.weights.push_back(bends ? softened * shape.length * shape.length / shape.area() : 0.0);
    table.rest.push_back(bends ? hinge_angle(rest_positions[a], rest_positions[b],
                                             rest_positions[c], rest_positions[d])
                               : HingeAngle{});
    table.areas.push_back(bends ? shape.areas : std::array{1.0, 1.0});
  }
  return table;
}

}  // namespace pneuma::sim
