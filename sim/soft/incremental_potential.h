// The incremental potential: the function of a body's positions x that an implicit step minimises:
//
//   E(x) = A/2 |x - y|^2  +  s/2 sum over springs (l - r)^2  +  hinges(x)  +  gas(V)  + friction(x)
//
// y is where the vertices would be without springs and gas, A their inertia, and s, r the stiffness
// and rest lengths of springs and dashpots together (implicit_step.h says which), likewise those of
// the hinges. gas(V) is that of
// gas_law.h, -nRT ln V unless chosen otherwise. E grows without bound as V -> 0 and as |x| ->
// infinity, so that it has a minimum with V > 0. Where there is a ground, x is to stay above it,
// and some vertices at their friction anchors. Pinned vertices are at y, which is where they are to
// be.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/mesh/soft_mesh.h"
#include "sim/soft/gas_law.h"
#include "sim/soft/vertex_matrix.h"

namespace pneuma::sim {

struct IncrementalPotential {
  explicit IncrementalPotential(const SoftMesh& mesh);

  double inertia = 0.0;              // A, N/m
  VertexArray target;                // y, m
  double stiffness = 0.0;            // s, N/m
  std::vector<double> rest_lengths;  // r, m, per edge
  double bending = 0.0;              // N m, of the hinges
  HingeTable hinges;                 // of springs and dashpots together; none if the mesh has none
  GasLaw gas;                        // of no strength: V may be anything

  const std::uint8_t* is_pinned = nullptr;  // per vertex: it is at its target; null: none is

  bool ground = false;
  std::vector<double> floor;  // m, per vertex: z is not to be below

  bool friction = false;
  VertexArray friction_anchor;         // m, per vertex: where static friction would hold it
  std::vector<char> anchored;          // per vertex: held there, x and y are the anchor's
  std::vector<double> friction_bound;  // N, per vertex: max friction; 0 if anchored
  double regularisation_length = 1.0;  // m from the anchor at which friction reaches its bound
};

/// Whether some coordinates may be held.
inline bool has_bounds(const IncrementalPotential& energy) {
  return energy.ground || energy.is_pinned != nullptr;
}
inline bool is_pinned(const IncrementalPotential& energy, int v) {
  return energy.is_pinned != nullptr && energy.is_pinned[v] != 0;
}

/// From its friction anchor to a vertex, across the ground, m.
inline Eigen::Vector2d slide(const IncrementalPotential& energy, const VertexArray& positions,
                             int v) {
  return (positions[v] - energy.friction_anchor[v]).head<2>();
}

/// Positions at which the energy is known.
struct EnergyPoint {
  explicit EnergyPoint(const SoftMesh& mesh);

  VertexArray positions;        // m; the rest belongs to it
  std::vector<double> lengths;  // m, of the edges
  VertexArray volume_gradient;  // m^2
  double volume = 1.0;          // m^3; 1 without gas
  double energy = 0.0;          // J
  double magnitude = 0.0;  // J: the sizes of its terms added up, of which rounding is a fraction
};

/// Fills in everything but the positions. False when V is not above zero or something is not
/// finite: then the energy means nothing.
bool evaluate(const SoftMesh& mesh, const IncrementalPotential& energy, EnergyPoint& point);

/// P - p0 in pascal at a point that has been evaluated; 0 without gas.
double pressure(const IncrementalPotential& energy, const EnergyPoint& point);

/// dE/dx in N at a point that has been evaluated, without the part of the gas, -(P - p0) dV/dx.
void gradient_without_gas(const SoftMesh& mesh, const IncrementalPotential& energy,
                          const EnergyPoint& point, VertexArray& gradient);

/// The two vertices across each edge: first of the triangle that runs through the edge forwards,
/// from its first vertex to its second.
std::vector<std::array<int, 2>> opposite_vertices(const MeshTopology& topology);

/// What an edge adds to d^2E/dx^2, N/m: to both of its ends' own blocks, and to the block in the
/// rows of its first and the columns of its second vertex. `pressure`: P - p0 at the point, Pa.
struct EdgeHessian {
  Mat3x4 own;
  Mat3x4 between;
};
void find_edge_hessian(const SoftMesh& mesh, const IncrementalPotential& energy,
                       const EnergyPoint& point, double pressure,
                       const std::vector<std::array<int, 2>>& opposite, std::size_t edge,
                       EdgeHessian& hessian);

/// d^2E/dx^2 in N/m at a point that has been evaluated, without the gas's term P/V dV/dx dV/dx^T,
/// which would fill the matrix.
void hessian_without_rank_one(const SoftMesh& mesh, const IncrementalPotential& energy,
                              const EnergyPoint& point,
                              const std::vector<std::array<int, 2>>& opposite,
                              VertexMatrix& hessian);

}  // namespace pneuma::sim
