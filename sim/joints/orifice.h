// Gas through a hole: the isentropic nozzle of Saint-Venant and Wantzel (1839), as in Shapiro, "The
// Dynamics and Thermodynamics of Compressible Fluid Flow" (1953), chapter 4. Of r = p / P, the
// pressure behind the hole over that before it,
//
//   J = P / sqrt(M R T) sqrt(2 g / (g - 1) (r^(2/g) - r^((g + 1)/g))),    r at least r*,
//
// r* = (2 / (g + 1))^(g / (g - 1)) = 0.528: below it the jet is as fast as sound and the flow
// choked. The gas is air: M = 0.0289644 kg/mol (U.S. Standard Atmosphere, 1976), g = 1.4, whatever
// the exponent of the body's gas, since within the jet there is no time for heat.
//
// J has an infinite slope at r = 1. Slow jets are laminar, and their flow is in proportion to the
// difference of pressure: from r = 0.999 on it is J(0.999) (1 - r) / 0.001.
#pragma once

#include "sim/world/gas_supply.h"

namespace pneuma::sim {

/// J in mol/(m^2 s), from a pressure P in Pa and a temperature T in K to a pressure of at most P.
double orifice_flux(double from_pressure, double from_temperature, double to_pressure);

/// m^2, by which the flux is multiplied.
inline double effective_area(const Orifice& orifice) { return orifice.discharge * orifice.area; }

}  // namespace pneuma::sim
