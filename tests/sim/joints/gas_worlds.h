// Worlds whose gas comes and goes, and the orifice's law once more, written from its form in Mach
// numbers.
#pragma once

#include <array>
#include <cmath>
#include <memory>

#include "sim/soft/gas_law.h"
#include "sim/soft/pins.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {

inline constexpr std::array all_integrators = {
    Integrator::martin, Integrator::symplectic_euler, Integrator::velocity_verlet, Integrator::rk4,
    Integrator::rk8,    Integrator::implicit_euler,   Integrator::sdirk2};

inline constexpr double air_pressure = 101325.0;  // Pa

/// mol/(m^2 s). Isentropic flow: with p/P = (1 + (g - 1)/2 Ma^2)^(-g/(g - 1)) and at most Ma = 1
/// the flux is P sqrt(g / (M R T)) Ma (1 + (g - 1)/2 Ma^2)^(-(g + 1)/(2 (g - 1))). Laminar, in
/// proportion to P - p, from p/P = 0.999 on.
inline double flux_by_mach_number(double from, double temperature, double to) {
  constexpr double g = 1.4;
  const double scale = from * std::sqrt(g / (0.0289644 * 8.314472 * temperature));
  const auto of_ratio = [&](double ratio) {
    const double mach =
        std::min(1.0, std::sqrt(2.0 / (g - 1.0) * (std::pow(ratio, -(g - 1.0) / g) - 1.0)));
    return scale * mach *
           std::pow(1.0 + 0.5 * (g - 1.0) * mach * mach, -(g + 1.0) / (2.0 * (g - 1.0)));
  };
  const double ratio = to / from;
  return ratio <= 0.999 ? of_ratio(ratio) : of_ratio(0.999) * (1.0 - ratio) / 0.001;
}

/// A ball in air whose pressure is so much that outside, and whose vertices are all pinned if it is
/// `stiff`.
inline SoftBody make_ball(double radius, double pressure, bool stiff,
                          const Vec3& centre = Vec3::Zero()) {
  SoftBody ball = make_body(make_icosphere(radius, 1), centre);
  SoftMaterial& material = ball.material;
  material.k = 400.0;
  material.vertex_mass = 0.05;
  material.ambient_pressure = air_pressure;
  material.start_volume = volume(ball.mesh->topology, ball.positions);
  material.n =
      pressure * air_pressure * material.start_volume / (gas_constant * material.temperature);
  if (stiff) {
    const auto count = static_cast<std::size_t>(ball.positions.size());
    ball.pins = make_pins(ball.positions, std::vector<std::uint8_t>(count, 1),
                          std::vector<std::uint8_t>(count), {});
  }
  return ball;
}

/// Pa.
inline double pressure_of(const SoftBody& body) {
  return absolute_pressure(gas_law(body.material), volume_of(body));
}

inline void give_leak(SoftBody& body, double area) {
  GasSupply supply;
  supply.leak.area = area;
  supply.outside_temperature = body.material.temperature;
  body.supply = std::make_shared<const GasSupply>(supply);
}

}  // namespace pneuma::sim
