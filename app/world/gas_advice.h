// Whether a scene's bodies keep about the size that they are given.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::app {

struct GasAdvice {
  std::string body;
  int count = 1;  // of bodies like it
  int vertices = 0;
  bool left_out = false;            // too many vertices: no more is known than the next
  double volume = 0.0;              // m^3, at the start
  std::optional<double> settled;    // m^3 at rest and without weight (settled_volume.h)
  std::optional<double> max_held;   // mol; of a body that leaves its shape: the most with which
                                    // rest = "equilibrium" keeps it; none: it cannot hold it
  bool held = false;                // its springs balance its gas in its shape, or nearly
  std::optional<double> steady_k;   // N/m: from there on they do without folding at a push; none:
                                    // they do, or it is not known
  double settled_pressure = 0.0;    // Pa above the ambient pressure, at rest
  double set_free = 0.0;            // J, from the start to rest; 0: not known, or it shrinks
  bool shatters = false;            // by that energy
  double mass = 0.0;                // kg in all
  std::optional<double> held_mass;  // kg in all, that such gas carries; none: any, or no weight
  // s: when keys of supply give it the most gas, with which all of this is; none: at the start.
  std::optional<double> filled_at;
  double k = 0.0;            // N/m, of its springs
  double bending = 0.0;      // N m, of its hinges
  double n = 0.0;            // mol, of its gas
  double temperature = 0.0;  // K
  double weight = 0.0;       // N, on the ground
  bool limp = false;         // no gas, and springs that do not hold up its weight
  // m^3 in which its gas would carry its weight on all of its ground plan; none: nothing to carry
  // it, or no weight.
  std::optional<double> pressed;
  double pressure_at_start = 0.0;  // Pa above the ambient pressure
  double ambient_pressure = 0.0;   // Pa
  // What would make that nearly its volume:
  double light_mass = 0.0;             // kg in all
  double carrying_pressure = 0.0;      // Pa above the ambient pressure, at the start
  std::optional<double> strengthened;  // times its gas and its springs, which keeps its shape;
                                       // none: its gas does not press, or air does too

  bool blown_up() const;      // to more than twice its volume; if keys fill it, its length
  bool bursts() const;        // it starts so far from rest that its shape is lost on the way
  bool crushed() const;       // by its weight, to less than half its volume, or being limp
  bool leaves_shape() const;  // being held: it folds, or rests at another volume
  /// Times the gas with which springs keep the shape, if it has more; 1: it does not, or no gas
  /// would do.
  double gas_over_held() const;
};

/// Vertices of all distinct bodies for which there is advice: before a run it is to take well below
/// a second, where it is asked for some tens (settled_volume.h).
inline constexpr int quick_advice = 3'000, patient_advice = 100'000;

/// Of one body for each mesh and material, up to so many vertices in all. There is no advice
/// against bodies that contacts press together.
std::vector<GasAdvice> gas_advices(const sim::World& world, int max_vertices = patient_advice);

}  // namespace pneuma::app
