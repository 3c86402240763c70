#include "sim/soft/gas_law.h"

#include <cmath>

namespace pneuma::sim {

GasLaw gas_law(const SoftMaterial& material) {
  const double strength = gas_strength(material);
  if (!(strength > 0.0)) return {};
  return {strength, material.gas_exponent, material.start_volume, material.ambient_pressure};
}

double absolute_pressure(const GasLaw& law, double volume) {
  if (law.exponent == 1.0) return law.strength / volume;
  return law.strength / law.start_volume * std::pow(law.start_volume / volume, law.exponent);
}

double gas_energy(const GasLaw& law, double volume) {
  if (!(law.strength > 0.0)) return 0.0;
  if (law.exponent == 1.0) return -law.strength * std::log(volume) + law.ambient_pressure * volume;
  // expm1 keeps the digits where g is nearly 1 or V nearly V0.
  const double less = law.exponent - 1.0;
  const double work = std::expm1(-less * std::log(volume / law.start_volume)) / less;
  return law.strength * (work - std::log(law.start_volume)) + law.ambient_pressure * volume;
}

double gas_energy_size(const GasLaw& law, double volume) {
  const double outside = law.strength > 0.0 ? law.ambient_pressure * volume : 0.0;
  return std::abs(gas_energy(law, volume) - outside) + outside;
}

}  // namespace pneuma::sim
