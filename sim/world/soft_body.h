// A soft body as plain data (section 3).
// Units: metre, kilogram, second, kelvin, mole.
#pragma once

#include <memory>
#include <string>

#include "sim/mesh/soft_mesh.h"
#include "sim/mesh/vertex_array.h"
#include "sim/world/contact_material.h"
#include "sim/world/gas_supply.h"
#include "sim/world/pins.h"

namespace pneuma::sim {

/// J/(mol K); the value of the author's program (ERRATA row 28).
inline constexpr double gas_constant = 8.314472;

/// How triangle pressure forces reach the vertices (ERRATA row 4).
enum class PressureWeighting {
  uniform,  // exactly P dV/dx: conservative, no net force
  valence,  // the paper's springs / average springs: a free body propels itself
};

/// ERRATA row 5.
enum class Damping {
  dashpot,  // a continuous model: drag on the velocity, dashpots along the springs
  literal,  // the paper's v' = v - rho v in every step, whatever its length
};

/// Section 3.1's constants of one body (ERRATA rows 25 and 28).
struct SoftMaterial {
  double k = 50.0;              // spring constant, N/m, >= 0
  double n = 10.0;              // amount of gas, mol, >= 0; 0 is an empty membrane
  double temperature = 293.15;  // K, >= 0
  // ERRATA row 69, sim/soft/gas_law.h.
  double gas_exponent = 1.0;      // >= 1; 1: isothermal
  double start_volume = 1.0;      // m^3, at which the gas has its temperature
  double ambient_pressure = 0.0;  // Pa, outside of a body with gas
  double vertex_mass = 0.35;      // kg, > 0
  double bending = 0.0;           // N m, >= 0: rigidity of the surface; needs SoftMesh::hinges
  double bending_damping = 0.0;   // s, >= 0: relaxation time of the hinges (sim/soft/bending.h)
  PressureWeighting pressure_weighting = PressureWeighting::uniform;
  Damping damping = Damping::dashpot;
  // Fraction of the velocity lost, 0 <= rho_g < 1: per 1/60 s under `dashpot`, and per step,
  // whatever its length, under `literal`.
  double rho_g = 0.01;
  double k_max = 400.0;  // N/m; springs at or beyond it are damped as much as is ever done
  ContactMaterial surface;
};

struct SoftBody {
  std::string name;
  std::shared_ptr<const SoftMesh> mesh;
  SoftMaterial material;
  VertexArray positions;             // m
  VertexArray velocities;            // m/s
  std::shared_ptr<const Pins> pins;  // if some of its vertices are held
  std::shared_ptr<const GasSupply>
      supply;  // if its gas comes and goes: n and temperature are state
};

/// An obstacle: nothing changes how it moves.
inline bool is_kinematic(const SoftBody& body) { return body.pins && body.pins->are_all; }
/// Whether it is an obstacle that never moves.
inline bool is_still(const SoftBody& body) { return is_kinematic(body) && !body.pins->are_moved; }

}  // namespace pneuma::sim
