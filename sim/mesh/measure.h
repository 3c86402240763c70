// Lengths, areas, volumes and normals of a mesh given the current positions of its vertices.
#pragma once

#include <limits>
#include <vector>

#include "sim/mesh/topology.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

struct Bounds {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void include(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void include(const Bounds& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  Vec3 centre() const { return 0.5 * (low + high); }
  Vec3 size() const { return high - low; }
};

Bounds bounds(const VertexArray& positions);

/// Mean of the vertices: the centre of mass of a body of equal point masses.
Vec3 mean(const VertexArray& values);

/// m, from there to the farthest vertex.
double radius(const VertexArray& positions);

/// Signed volume in m^3, positive for outward triangles (paper 3.1.2 with the sign of ERRATA row
/// 2), summed about one of the body's vertices so that a body far from the origin keeps its digits.
double volume(const MeshTopology& topology, const VertexArray& positions);

/// Half the cross product of two sides: outward, its length is the area in m^2.
Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c);

double surface_area(const MeshTopology& topology, const VertexArray& positions);

/// Unit normals of all vertices, each the average of its triangles' normals weighted by area.
/// A vertex whose triangles cancel gets +z.
void vertex_normals(const MeshTopology& topology, const VertexArray& positions,
                    std::vector<Vec3>& normals);

VertexArray to_vertex_array(const std::vector<Vec3>& points);

}  // namespace pneuma::sim
