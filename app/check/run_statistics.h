// What a run of a scene comes to, in numbers.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "app/check/volume_range.h"
#include "app/record/contact_tally.h"
#include "app/world/simulation.h"
#include "scenes/loader/scene.h"
#include "sim/inspect/inspect.h"

namespace pneuma::app {

/// A greatest value and when it was reached, s.
struct Peak {
  double value = 0.0;
  double time = 0.0;
};

/// What a value does over a run.
struct ValueRange {
  double start = std::numeric_limits<double>::quiet_NaN();  // until there is one
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();
  double end = std::numeric_limits<double>::quiet_NaN();
};

/// Of a soft body, while it has gas.
struct GasRange {
  std::string body;
  ValueRange pressure;  // Pa above that outside
  ValueRange n;         // mol
};

/// Slower than this, m/s, a body is called at rest; one that is shorter than a metre, slower than
/// that times its length in metres, as bodies fall asleep (sim/response/fall_asleep.h). On the
/// ground gravity adds 0.16 m/s in every 1/60 s, which the contact takes away again: the third of
/// it is what may be left over.
inline constexpr double rest_speed = 0.05;

/// s, for which nothing may be faster: what swings stands still twice in every period.
inline constexpr double rest_time = 0.5;

/// Of all bodies but those that move as they are told to; of a soft one over a frame.
struct FastestPoint {
  double speed = 0.0;         // m/s
  std::string body;           // empty: nothing moves
  double limit = rest_speed;  // m/s, below which that body is called at rest

  double over_limit() const { return speed / limit; }
};

/// How often and how much surfaces passed through each other, in the frames of a run.
struct CrossingStatistics {
  int frames = 0;            // in which some did
  Peak edges;                // that passed through another surface at once
  std::string first_bodies;  // of that moment, "torus and cube 3"; empty: none
  int more = 0;              // pairs of bodies, or bodies, of that moment beside these
};

/// Bodies that swept contacts have let into the ground, by more than a touch: boxes by more than a
/// hundredth of their shortest side, soft bodies by more than a fiftieth of their least extent.
struct SunkStatistics {
  int frames = 0;    // in which some were
  Peak depth;        // m
  std::string body;  // of that moment; empty: none
};

/// Bodies that start in each other.
struct StartOverlapStatistics {
  int pairs = 0;
  int left = 0;         // pairs that still are at the end of the run
  double parted = 0.0;  // s, when the last of the others came apart
  std::string bodies;   // of the first pair
};

/// Contacts are looked at in every step; penetration, energy and volumes at the start and in every
/// frame, since that is how often the scene's pictures are taken.
struct RunStatistics {
  std::int64_t steps = 0;                 // done
  double seconds = 0.0;                   // of the scene's time
  std::optional<std::string> divergence;  // where the run ended early; what follows is up to there

  int divided_steps = 0;  // that diverged and were done again in parts
  int most_parts = 0;     // of one of them

  Peak penetration;                  // m, over the whole run
  std::string penetration_bodies;    // "torus and cube 3", of that moment; empty: none
  double start_penetration = 0.0;    // m
  double settled_penetration = 0.0;  // m, over the last half of it
  int frames = 0;                    // looked at, the start among them
  CrossingStatistics crossings;      // of different bodies, beyond a touch (app/world/touch.h)
  int touching_frames = 0;           // in which bodies cross by no more than a touch
  SunkStatistics sunk;
  StartOverlapStatistics start_overlap;
  CrossingStatistics self_crossings;  // of bodies with themselves
  bool may_use_potential = false;     // which would rule them out, where there are some
  double end_overlap = 0.0;           // m, of the pair deepest in each other at the end (overlap.h)
  std::string end_overlap_bodies;     // empty: none
  ContactTally contacts;
  ContactTally settled_contacts;  // over the last half of the run

  sim::Energy energy_start;
  sim::Energy energy_end;
  // J, from one frame to the next, less the work below: the greatest, and all of them together.
  Peak energy_rise;
  double energy_rises = 0.0;
  // J, of the bodies that are moved on what they pushed; none: there is no such body.
  std::optional<double> driven_work;
  bool pins_move = false;  // of bodies that are not moved whole: they do work that is not known
  bool springs_are_moved = false;  // by bodies that are: so do they
  // J, by which gas that came, went or was heated changed the energy of gas; none: none does.
  std::optional<double> gas_work;
  bool has_gas_in_vacuum = false;  // without ambient pressure, at any time
  double energy_span = 0.0;  // J, between the greatest and the least: what a rise is judged by

  std::vector<VolumeRange> volumes;  // of the soft bodies, and of obstacles among them
  std::vector<GasRange> gas;         // of the soft bodies that ever have some

  // "gravity", "the ground", ...: what changes the momentum of all bodies together.
  std::vector<std::string> pushed_by;
  sim::Momentum momentum_start;
  sim::Momentum momentum_end;

  FastestPoint at_end;
  FastestPoint liveliest_at_end;  // that with the greatest part of its body's limit
  // s, of the first frame from which on nothing was faster than its limit; none: that was not so
  // for the last rest_time.
  std::optional<double> rests_from;
  std::uint64_t state_hash = 0;
};

/// Runs the scene without pictures, by default as `pneuma render` does: a step that diverges is
/// done in parts where it is short enough for small motions. `threads` changes nothing but the time
/// that takes.
RunStatistics run_statistics(const scenes::Scene& scene, int threads,
                             OnDivergence on_divergence = OnDivergence::automatic);

}  // namespace pneuma::app
