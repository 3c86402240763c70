// The hinges of a mesh: each edge with its two triangles, which resist being bent out of the angle
// at which they are at rest.
//
// The angle t between two triangles is 0 where they are flat, positive where the surface is convex.
// It is measured by the distance of their unit normals, q = +-|n1 - n2| = 2 sin(t/2), which needs
// no arc functions. On a lattice of equilateral triangles, hinges of the energy K/2 (q - q0)^2 make
// a plate of the bending rigidity K sqrt(3)/2 (Seung and Nelson, Defects in flexible membranes with
// crystalline order, 1988). With an edge of length l between triangles of the areas A1 and A2, K =
// rigidity l^2 / (A1 + A2) is that, and on other meshes nearly so: Grinspun et al., Discrete
// shells, 2003, weight hinges likewise.
#pragma once

#include <array>
#include <vector>

#include "sim/mesh/topology.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

struct HingeTable {
  /// Heights of triangles below this fraction of the mesh's mean height are slivers. K's action at
  /// a vertex grows with 1 / height^3, and a single sliver would decide the step of all: K is
  /// lowered in proportion to height^3, so that it acts there as on triangles of this height.
  static constexpr double sliver_height = 0.5;

  /// a, b, c, d: the edge's vertices, then those across it; the triangles are a b c and b a d.
  using Corners = std::array<int, 4>;

  std::vector<Corners> corners;     // per edge
  std::vector<double> weights;      // K / rigidity, per edge
  std::vector<double> rest_values;  // q0, per edge
};

/// q of a hinge at these positions.
double hinge_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// At rest at these positions. Hinges of triangles without area have no weight.
HingeTable make_hinges(const MeshTopology& topology, const VertexArray& rest_positions);

}  // namespace pneuma::sim
