// How well a side simulates a scene: told from its states alone, for both sides alike.
#pragma once

#include "benchmarks/peer/simulation.h"

namespace pneuma::benchmarks {

struct Quality {
  double inflation = 1.0;  // V end / V start, of all soft bodies; mean over the last second
  double end_speed = 0.0;  // m/s, of the centre of the fastest body; greatest of the last second
  double deepest = 0.0;    // m that two bodies lie in each other, or one in the ground, in the
                           // second half (sim::overlaps)
  int crossings = 0;       // edges that pass through other bodies, the most at one look there
};

/// What a peer's setting must reach to stand beside ours. Where ours does worse than these bounds,
/// as well as ours is enough.
inline constexpr double inflation_bound = 0.1;  // |inflation / ours - 1|
inline constexpr double speed_bound = 0.05;     // m/s
inline constexpr double depth_bound = 0.05;     // m

bool inflates_like(const Quality& peer, const Quality& ours);
bool rests_like(const Quality& peer, const Quality& ours);
bool keeps_apart_like(const Quality& peer, const Quality& ours);
inline bool reaches(const Quality& peer, const Quality& ours) {
  return inflates_like(peer, ours) && rests_like(peer, ours) && keeps_apart_like(peer, ours);
}

/// 0 where `peer` reaches `ours`, else grows with what is missed most, rest before all.
double shortfall(const Quality& peer, const Quality& ours);

struct Trial {
  Quality quality;
  double frame_seconds = 0.0;  // processor time of 1/60 s, mean over the second half
};

/// Runs a simulation from its start for `seconds`; looks every half second of the second half, and
/// at speeds and volumes ten times in the last second. A run whose volume is no longer a number, or
/// beyond a hundred times that at the start, ends at once with an infinite inflation.
Trial try_out(Simulation& simulation, double seconds);

/// Volume of all soft bodies, m^3.
double soft_volume(const sim::World& world);

}  // namespace pneuma::benchmarks
