// How far a free body propels itself, by the way the pressure reaches its vertices (ERRATA row 4).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::app {

struct DriftOptions {
  int trials = 20;
  double seconds = 5.0;
  int steps_per_second = 240;  // of rk4
};

/// One body whose vertices start off their places, at random and at rest, without gravity, ground
/// and anything else: whatever moves its centre of mass comes from inside.
struct DriftTrial {
  double net_force = 0.0;         // at the start, over the mean force on a vertex
  std::vector<double> distances;  // of the centre from its start, over the rest radius, per sample
};

struct DriftStudy {
  double seconds = 0.0;
  double perturbation = 0.0;  // m, of each coordinate at most
  std::vector<DriftTrial> uniform;
  std::vector<DriftTrial> valence;  // from the same starts
};

/// Samples are app/study/error/samples.h's. Throws DivergenceError and Interrupted.
DriftStudy study_drift(const sim::SoftBody& body, const DriftOptions& options);

/// The min., median and max. distance at the end.
std::array<double, 3> drift_range(const std::vector<DriftTrial>& trials);
/// Likewise of the net force at the start.
std::array<double, 3> force_range(const std::vector<DriftTrial>& trials);

/// "left to itself for 5 s, the body moves by 0.01 to 0.2 (median 0.1) of its rest radius under
/// valence, by 1e-14 at most under uniform".
std::string drift_sentence(const DriftStudy& study);

}  // namespace pneuma::app
