// A triangle mesh as plain data, and the names for vectors used all over the simulation.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

namespace pneuma::sim {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Counts and indices are int, as Eigen and the mesh use them; standard containers want size_t.
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Three vertex indices, counter-clockwise when seen from outside.
using Triangle = std::array<int, 3>;

/// Positions in metres. A mesh that becomes a soft body must be closed, manifold and oriented
/// outwards; MeshTopology checks the first two.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

}  // namespace pneuma::sim
