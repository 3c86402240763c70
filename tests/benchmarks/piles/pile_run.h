// A pile of boxes stepped by ours or by Bullet, and what the oracle says of it.
#pragma once

#include "benchmarks/piles/pile_worlds.h"

namespace pneuma::benchmarks {

struct PileResult {
  double awake_seconds = 0.0;  // run time of a step in which something moved, median
  double end_seconds = 0.0;    // of the last tenth of the steps, median
  double deepest = 0.0;        // m, greatest penetration after the first second of contact
  double end_speed = 0.0;      // m/s, of the fastest box's centre or vertex
  double drift = 0.0;          // m sideways, of the last box
  double rests_at = 0.0;       // s from which on nothing was faster than 0.01 m/s; infinite: never
  int crossings = 0;           // edges between bodies, over all looks
};

struct PileOptions {
  int look_every = 6;          // steps between two looks of the oracle
  bool without_sleep = false;  // ours; Bullet's is off
};

/// Throws app::DivergenceError.
PileResult run_ours(const PileWorld& pile, const PileOptions& options);
PileResult run_bullet(const PileWorld& pile, const PileOptions& options);

}  // namespace pneuma::benchmarks
