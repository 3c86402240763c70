// Rest lengths with which a shape is held by its own gas (ERRATA row 27).
//
// A membrane whose springs are at rest in the shape that was modelled leaves it as soon as gas
// pushes: it wants to be a ball. The shape is the equilibrium instead if the springs are stretched
// or pressed by tensions t that balance the pressure P of that shape, above the one outside,
//
//   sum over the springs of a vertex of t d  +  w P dV/dx  =  0,    L = l - t / k,
//
// d along the spring away from the vertex. A closed mesh of genus g has 3 V - 6 + 6 g springs and
// as many tensions, and 3 V - 6 of these equations are independent: there is one solution on a
// sphere and a choice on a torus, of which the one with the smallest sum of t^2 is taken. Almost
// every such framework is rigid (Gluck 1975), but where the surface is nearly flat or saddle-shaped
// it is so by a hair: there are loads that only enormous tensions balance, and with these the
// equilibrium may be unstable. `softening` leaves such loads alone; the shape then yields to them a
// little.
#pragma once

#include <stdexcept>
#include <vector>

#include "sim/mesh/topology.h"
#include "sim/mesh/vertex_array.h"
#include "sim/world/soft_body.h"

namespace pneuma::sim {

struct EquilibriumOptions {
  /// Loads are given up whose stiffness is well below this fraction of k; >= 0, and at most
  /// about 1. 0 balances all of them.
  double softening = 0.1;
  /// Fraction of the pressure force that may stay unbalanced, 0..1.
  double max_residual = 0.3;
};

/// All of the pressure balanced, up to rounding: for shapes that curve outwards everywhere.
inline constexpr EquilibriumOptions exact_equilibrium = {0.0, 1e-9};

struct Equilibrium {
  std::vector<double> rest_lengths;  // m, per edge
  double residual = 0.0;             // fraction of the pressure force left unbalanced (of its norm)
};

/// There are no such rest lengths. The message says why, and what to do.
class EquilibriumError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Tensions that balance the pressure as far as the softening lets them, whatever k is.
struct Balance {
  std::vector<double> tensions;  // N, per edge
  double residual = 0.0;         // as above
};

/// Of the material's gas, temperature and pressure weighting. Throws EquilibriumError when the
/// shape has no volume or the material no springs, and when the pressure has a net force or torque
/// (`valence`).
Balance find_balance(const MeshTopology& topology, const VertexArray& positions,
                     const SoftMaterial& material, double softening);

/// m, per edge, with which springs of the material's k have these tensions. Throws EquilibriumError
/// when one would not be above zero.
std::vector<double> rest_lengths(const MeshTopology& topology, const VertexArray& positions,
                                 const SoftMaterial& material, const std::vector<double>& tensions);

/// (l - L) / l of the spring that is stretched most; 0 when none is. From 1 on there is no rest
/// length.
double greatest_strain(const MeshTopology& topology, const VertexArray& positions,
                       const SoftMaterial& material, const std::vector<double>& tensions);

/// mol, with which the gas pushes no more than what is outside; 0 without ambient pressure.
double balanced_gas(const MeshTopology& topology, const VertexArray& positions,
                    const SoftMaterial& material);

/// Rest lengths for the material's k, gas, temperature and pressure weighting. Without gas they are
/// the lengths themselves. Throws EquilibriumError when the shape has no volume or the material no
/// springs, when the pressure has a net force or torque (`valence`), when a rest length would not
/// be above zero, and when more of the pressure stays unbalanced than allowed.
Equilibrium find_equilibrium(const MeshTopology& topology, const VertexArray& positions,
                             const SoftMaterial& material, const EquilibriumOptions& options = {});

}  // namespace pneuma::sim
