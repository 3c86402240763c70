#include "sim/soft/incremental_potential.h"

#include <algorithm>
#include <cmath>

#include "sim/soft/bending.h"
#include "sim/soft/pressure_force.h"

namespace pneuma::sim {
namespace {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

/// Sliding friction as a potential: its force grows with the slide u up to the
/// regularisation length, and is the friction bound from there on (Li et al., Incremental Potential
/// Contact, 2020, section 5.2, with the simplest function that does so).
double friction_energy(const IncrementalPotential& energy, const VertexArray& positions) {
  double sum = 0.0;
  for (int v = 0; v < positions.size(); ++v) {
    if (energy.friction_bound[at(v)] == 0.0) continue;
    const double u = slide(energy, positions, v).norm();
    sum += energy.friction_bound[at(v)] * (u < energy.regularisation_length
                                               ? 0.5 * u * u / energy.regularisation_length
                                               : u - 0.5 * energy.regularisation_length);
  }
  return sum;
}

void add_friction_gradient(const IncrementalPotential& energy, const VertexArray& positions,
                           VertexArray& gradient) {
  for (int v = 0; v < positions.size(); ++v) {
    if (energy.friction_bound[at(v)] == 0.0) continue;
    const Vec2 u = slide(energy, positions, v);
    gradient[v].head<2>() +=
        energy.friction_bound[at(v)] / std::max(u.norm(), energy.regularisation_length) * u;
  }
}

void add_friction_hessian(const IncrementalPotential& energy, const VertexArray& positions,
                          VertexMatrix& hessian) {
  for (int v = 0; v < positions.size(); ++v) {
    if (energy.friction_bound[at(v)] == 0.0) continue;
    const Vec2 u = slide(energy, positions, v);
    const double size = u.norm();
    Mat2 block = Mat2::Identity();
    if (size >= energy.regularisation_length) block -= u * u.transpose() / (size * size);
    Mat3 whole = Mat3::Zero();
    whole.topLeftCorner<2, 2>() =
        energy.friction_bound[at(v)] / std::max(size, energy.regularisation_length) * block;
    hessian.add(v, mat3x4(whole));
  }
}

/// Of s/2 (l - r)^2 in the ends' own rows and columns, and negative between them: stiff along the
/// spring, across it by as much as the spring is stretched. A spring of no length has no direction.
void put_spring_hessian(Vec4d edge, double length, double stiffness, double rest_length,
                        Mat3x4& hessian) {
  const bool has_direction = length > 0.0;
  const double inverse = has_direction ? 1.0 / length : 0.0;
  const Vec4d d = inverse * edge;
  const double rest = stiffness * rest_length * inverse;
  const double across = stiffness - rest;
  const Vec4d along = rest * d;
  hessian.columns[0] = fma(along[0], d, across * Vec4d{1.0});
  hessian.columns[1] = fma(along[1], d, across * Vec4d{0.0, 1.0});
  hessian.columns[2] = fma(along[2], d, across * Vec4d{0.0, 0.0, 1.0});
}

/// The matrix m of m u = w x u.
void put_cross_matrix(Vec4d w, Mat3x4& matrix) {
  const Vec4d minus = -w;
  matrix.columns[0] = __builtin_shufflevector(w, minus, 3, 2, 5, 3);
  matrix.columns[1] = __builtin_shufflevector(w, minus, 6, 3, 0, 3);
  matrix.columns[2] = __builtin_shufflevector(w, minus, 1, 4, 3, 3);
}

void add_bending_hessian(const IncrementalPotential& energy, const VertexArray& positions,
                         VertexMatrix& hessian) {
  for (int e = 0; e < static_cast<int>(energy.hinges.corners.size()); ++e) {
    const HingeHessian block = hinge_hessian(energy.hinges, positions, energy.bending, e);
    const HingeTable::Corners& corners = energy.hinges.corners[at(e)];
    for (int i = 0; i < 4; ++i) {
      hessian.add(corners[at(i)], mat3x4(block.block<3, 3>(3 * i, 3 * i)));
      for (int j = i + 1; j < 4; ++j) {
        hessian.add_between(corners[at(i)], corners[at(j)],
                            mat3x4(block.block<3, 3>(3 * i, 3 * j)));
      }
    }
  }
}

}  // namespace

IncrementalPotential::IncrementalPotential(const SoftMesh& mesh)
    : target(mesh.topology.vertex_count()),
      rest_lengths(mesh.rest_lengths.size()),
      hinges(mesh.hinges ? *mesh.hinges : HingeTable{}),
      floor(at(mesh.topology.vertex_count())),
      friction_anchor(mesh.topology.vertex_count()),
      anchored(at(mesh.topology.vertex_count())),
      friction_bound(at(mesh.topology.vertex_count())) {}

EnergyPoint::EnergyPoint(const SoftMesh& mesh)
    : positions(mesh.topology.vertex_count()),
      lengths(mesh.rest_lengths.size()),
      volume_gradient(mesh.topology.vertex_count()) {}

bool evaluate(const SoftMesh& mesh, const IncrementalPotential& energy, EnergyPoint& point) {
  const auto& x = point.positions.rows();
  const auto& edges = mesh.topology.edges();
  double squares = 0.0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    point.lengths[e] = (x.col(edges[e][1]) - x.col(edges[e][0])).norm();
    squares += std::pow(point.lengths[e] - energy.rest_lengths[e], 2);
  }
  point.energy = 0.5 * energy.inertia * (x - energy.target.rows()).squaredNorm() +
                 0.5 * energy.stiffness * squares;
  point.energy += bending_energy(energy.hinges, point.positions, energy.bending);
  if (energy.friction) point.energy += friction_energy(energy, point.positions);
  point.magnitude = point.energy;
  point.volume = 1.0;
  if (energy.gas.strength > 0.0) {
    volume_gradient(mesh.topology, point.positions, point.volume_gradient);
    point.volume = volume(point.positions, point.volume_gradient);
    if (!(point.volume > volume_rounding(point.positions, point.volume_gradient))) return false;
    point.energy += gas_energy(energy.gas, point.volume);
    point.magnitude += gas_energy_size(energy.gas, point.volume);
  }
  return std::isfinite(point.energy);
}

double pressure(const IncrementalPotential& energy, const EnergyPoint& point) {
  return energy.gas.strength > 0.0 ? gauge_pressure(energy.gas, point.volume) : 0.0;
}

void gradient_without_gas(const SoftMesh& mesh, const IncrementalPotential& energy,
                          const EnergyPoint& point, VertexArray& gradient) {
  const auto& x = point.positions.rows();
  auto& g = gradient.rows();
  g.noalias() = energy.inertia * (x - energy.target.rows());
  const auto& edges = mesh.topology.edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double length = point.lengths[e];
    if (!(length > 0.0)) continue;  // no direction: as in spring_force.h, no force
    const auto& [a, b] = edges[e];
    const double s = energy.stiffness * (length - energy.rest_lengths[e]) / length;
    const Eigen::Vector4d pull = s * (x.col(b) - x.col(a));
    g.col(a) -= pull;
    g.col(b) += pull;
  }
  add_bending_forces(energy.hinges, point.positions, -energy.bending, 1, gradient);
  if (energy.friction) add_friction_gradient(energy, point.positions, gradient);
}

std::vector<std::array<int, 2>> opposite_vertices(const MeshTopology& topology) {
  std::vector<std::array<int, 2>> opposite(at(topology.edge_count()));
  for (int t = 0; t < topology.triangle_count(); ++t) {
    const Triangle& corners = topology.triangles()[at(t)];
    for (std::size_t i = 0; i < 3; ++i) {
      const int edge = topology.triangle_edges()[at(t)][i];
      const bool forwards = topology.edges()[at(edge)][0] == corners[i];
      opposite[at(edge)][forwards ? 0 : 1] = corners[(i + 2) % 3];
    }
  }
  return opposite;
}

void find_edge_hessian(const SoftMesh& mesh, const IncrementalPotential& energy,
                       const EnergyPoint& point, double pressure,
                       const std::vector<std::array<int, 2>>& opposite, std::size_t edge,
                       EdgeHessian& hessian) {
  // V = sum of a . (b x c) / 6 is linear in each vertex. In b, the gradient b x c / 6 at a changes
  // by u x c / 6 with u: of an edge with c and c' across it, d^2V/da db u = u x (c - c') / 6.
  const VertexReader x(point.positions);
  const auto& [a, b] = mesh.topology.edges()[edge];
  put_spring_hessian(x[b] - x[a], point.lengths[edge], energy.stiffness, energy.rest_lengths[edge],
                     hessian.own);
  put_cross_matrix(pressure / 6.0 * (x[opposite[edge][0]] - x[opposite[edge][1]]), hessian.between);
  for (std::size_t i = 0; i < 3; ++i) hessian.between.columns[i] -= hessian.own.columns[i];
}

void hessian_without_rank_one(const SoftMesh& mesh, const IncrementalPotential& energy,
                              const EnergyPoint& point,
                              const std::vector<std::array<int, 2>>& opposite,
                              VertexMatrix& hessian) {
  hessian.set_identity(energy.inertia);
  const double gauge = pressure(energy, point);
  const auto& edges = mesh.topology.edges();
  EdgeHessian of_edge;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [a, b] = edges[e];
    find_edge_hessian(mesh, energy, point, gauge, opposite, e, of_edge);
    hessian.add(a, of_edge.own);
    hessian.add(b, of_edge.own);
    hessian.add_between(static_cast<int>(e), of_edge.between);
  }
  if (energy.bending > 0.0) add_bending_hessian(energy, point.positions, hessian);
  if (energy.friction) add_friction_hessian(energy, point.positions, hessian);
}

}  // namespace pneuma::sim
