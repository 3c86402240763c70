// The gas inside a body: P V^g stays what it is at the start volume V0, where P V0 = nRT (g = 1:
// isothermal, the paper's P V = nRT). Outside is the ambient pressure p0, so that the force is
// (P - p0) dV/dx, the negative gradient of
//
//   E(V) = nRT [((V / V0)^(1 - g) - 1) / (g - 1) - ln V0] + p0 V,
//
// which for g -> 1 is -nRT ln V + p0 V (volumes per m^3).
#pragma once

#include "sim/world/soft_body.h"

namespace pneuma::sim {

struct GasLaw {
  double strength = 0.0;          // nRT at the start volume, J; 0: no gas, nor anything outside
  double exponent = 1.0;          // g, >= 1
  double start_volume = 1.0;      // V0, m^3; means nothing if g = 1
  double ambient_pressure = 0.0;  // p0, Pa
};

/// nRT in joule.
inline double gas_strength(const SoftMaterial& material) {
  return material.n * gas_constant * material.temperature;
}

/// A body without gas is an open membrane: nothing outside presses on it either.
GasLaw gas_law(const SoftMaterial& material);

/// P in pascal; a volume above zero.
double absolute_pressure(const GasLaw& law, double volume);

/// P - p0 in pascal, which pushes outwards where it is above zero.
inline double gauge_pressure(const GasLaw& law, double volume) {
  return absolute_pressure(law, volume) - law.ambient_pressure;
}

/// -dP/dV = g P / V in Pa/m^3.
inline double pressure_slope(const GasLaw& law, double volume) {
  return law.exponent * absolute_pressure(law, volume) / volume;
}

/// E in joule; 0 without gas.
double gas_energy(const GasLaw& law, double volume);

inline double gas_energy(const SoftMaterial& material, double volume) {
  return gas_energy(gas_law(material), volume);
}

/// J: the sizes of E's parts inside and outside added up, of which rounding is a fraction.
double gas_energy_size(const GasLaw& law, double volume);

}  // namespace pneuma::sim
