// One world stepped by us and by Bullet, in turns, in one process.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/peer/quality.h"
#include "sim/world/world.h"

namespace pneuma::benchmarks {

/// What one side took, and what it simulated for that.
struct SideResult {
  int steps_per_second = 60;
  double seconds_per_second = 0.0;  // run time per simulated second, least of the repeats
  double contacts_per_step = 0.0;   // mean; ours are regions, Bullet's nodes
  Quality quality;                  // of a run that was not timed

  /// What the work of 1/60 s takes: one step, unless it needs shorter ones.
  double frame_seconds() const { return seconds_per_second / 60.0; }
};

struct PairedRun {
  std::string name;
  BulletOptions bullet_options;
  SideResult bullet;
  SideResult rk4;
  SideResult velocity_verlet;
};

struct PairedRunOptions {
  double seconds = 10.0;  // simulated; the second half, when bodies have met, is measured
  int repeats = 5;
  int threads = 1;  // of ours; Bullet's soft bodies know one
};

/// Bullet runs with `bullet`, ours with rk4 and with velocity_verlet. All start from `world`, with
/// its steps per second; an integrator of ours that diverges at those takes twice as many, up to
/// eight times, and so does velocity_verlet where it falls short of rk4. The time of every piece of
/// a few steps is the least of all repeats, which are taken in turns: whatever else the machine
/// does strikes both sides alike, and drops out. Throws app::DivergenceError.
PairedRun run_paired(const std::string& name, const sim::World& world, const BulletOptions& bullet,
                     const PairedRunOptions& options);

/// The first good one of `rate` and two and four times as much; eight times if none is.
int least_rate(int rate, const std::function<bool(int)>& is_good);

}  // namespace pneuma::benchmarks
