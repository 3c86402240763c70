// Gas that comes and goes: by keys, through leaks, through valves (sim/world/gas_supply.h).
//
// A step moves the bodies with the gas that they have at its middle. Before it and after it gas
// flows for half a step each while the volumes stand still (Strang splitting: of second order in
// the step, whatever the integrator; of first order if that is). Within these halves the flow's own
// equation is integrated to about 1e-8 by as many steps of the classical Runge-Kutta method as it
// takes.
//
// What flows carries energy. With an exponent of 1 the gas of a body stays at its temperature, so
// that d(nRT) = RT dn. With g > 1 the enthalpy g / (g - 1) RT' of each mole is kept, T' being the
// temperature where it comes from, so that at a constant volume d(PV) = g RT' dn: what leaves lets
// the rest expand along P ~ (n / V)^g, and what comes in from a higher pressure heats. For g = 1.4
// that is air without exchange of heat.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::sim {

/// Whether the gas of any body, or of this one, comes or goes: its n and temperature are then
/// state.
bool has_gas_flow(const World& world);
bool has_gas_flow(const World& world, int soft_body);

class GasFlow {
 public:
  /// Of a world of these bodies. Takes memory for all that follows.
  explicit GasFlow(const World& world);

  /// What happens to the gas before the bodies take the next step, and after they have.
  void begin_step(World& world);
  void end_step(World& world);
  /// As before begin_step.
  void take_back(World& world) const;

  /// J, by which the last step's changes of gas, at constant volumes, changed the energy that is
  /// reported for it (gas_energy). The zero of that energy depends on n.
  double work() const { return work_; }

 private:
  struct Part {
    int body = 0;
    bool has_openings = false;
    bool is_open = false;  // they and the volume are such that gas flows
    double volume = 0.0;   // m^3
    double exponent = 1.0;
    double outside = 0.0;  // Pa
    double leak = 0.0;     // m^2, effective
    double outside_temperature = 0.0;
    double per_strength = 0.0;  // Pa per J: the pressure is this times nRT at the start volume
    double temperature = 0.0;   // K, of an exponent of 1
    double reference = 0.0;     // Pa, the greater of its own and that outside as the flow begins
    double start_n = 0.0;       // mol, before the step
    double start_temperature = 0.0;
  };
  /// n in mol, and nRT at the start volume in J.
  struct Gas {
    double n = 0.0;
    double strength = 0.0;
  };
  struct Opening {
    std::size_t first = 0, second = 0;  // into parts_
    double area = 0.0;                  // m^2, effective
  };
  void measure(const World& world);
  void take_keys(World& world, double from, double to);
  void flow(World& world, double seconds);
  void empty();
  void take_runge_kutta_step(double step);
  double rates(const std::vector<Gas>& gas, std::vector<Gas>& change) const;
  double pressure(const Part& part, const Gas& gas) const;
  double temperature(const Part& part, const Gas& gas) const;
  double energy(const World& world) const;

  std::vector<Part> parts_;
  std::vector<Opening> valves_;
  std::vector<Gas> gas_, stage_;
  std::array<std::vector<Gas>, 4> slopes_;
  double work_ = 0.0;
};

}  // namespace pneuma::sim
