// The hinges of a mesh: each edge with its two triangles, which resist being bent out of the angle
// at which they are at rest.
//
// The angle t between two triangles is 0 where they are flat, positive where the surface is convex,
// t0 at rest. A hinge has the energy K (1 - cos(t - t0)): smooth all the way round, and without arc
// functions, since cos t = n1 . n2 and sin t = (n1 x n2) . d of the unit normals and of the edge's
// direction. Flat at rest it is K/2 |n1 - n2|^2, which on a lattice of equilateral triangles makes
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

struct HingeAngle {
  double cosine = 1.0, sine = 0.0;
};

struct HingeTable {
  /// Heights of triangles below this fraction of the mesh's mean height are slivers. K's action at
  /// a vertex grows with 1 / height^3, and a single sliver would decide the step of all: K is
  /// lowered in proportion to height^3, so that it acts there as on triangles of this height.
  static constexpr double sliver_height = 0.5;

  /// a, b, c, d: the edge's vertices, then those across it; the triangles are a b c and b a d.
  using Corners = std::array<int, 4>;

  std::vector<Corners> corners;              // per edge
  std::vector<double> weights;               // K / rigidity, per edge
  std::vector<HingeAngle> rest;              // t0, per edge
  std::vector<std::array<double, 2>> areas;  // m^2 at rest, per edge, of a b c and of b a d; > 0
};

/// t of a hinge at these positions.
HingeAngle hinge_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// At rest at these positions. Hinges of triangles without area have no weight.
HingeTable make_hinges(const MeshTopology& topology, const VertexArray& rest_positions);

}  // namespace pneuma::sim
