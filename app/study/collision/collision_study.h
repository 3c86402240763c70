// `pneuma study collision`: what each setting of the search for soft contacts finds and costs.
//
// The scene runs once, with the exact search, so that what is there to find does not depend on what
// was found. In every step each setting looks at the same surfaces: its particles persist and walk
// as they would in a run, but nothing follows from what they find.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/collision/detection.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

/// A search for the contacts of two soft bodies.
struct SearchSetting {
  sim::SoftSearch search = sim::SoftSearch::particles;
  sim::ParticleSettings particles;

  std::string name() const;  // "exact", "1/8 per vertex, 10 sweeps, attraction 2"
};

struct SearchResult {
  SearchSetting setting;
  DetectionScore score;
  double step_seconds = 0.0;  // median of the steps in which bodies are near each other
  double contacts = 0.0;      // mean of the same steps
  // m, the max. in a run of the scene's own with this search; for the settings that differ from
  // the default in the number of particles only.
  std::optional<double> penetration;
};

struct CollisionStudy {
  std::string scene;
  double skin_thickness = 0.0;        // m
  double seconds = 0.0;               // of the scene's time
  std::int64_t steps = 0;             // in which bodies are near each other
  std::vector<SearchResult> results;  // exact first

  const SearchResult& exact() const { return results.front(); }
};

/// A setting is said to find what touches when it finds this fraction of the regions and misses no
/// vertex that is deeper within reach than half of it: those are to be moved apart (5.3.1).
inline constexpr double required_region_share = 0.99;
bool finds_what_touches(const SearchResult& result, double skin_thickness);

/// The cheapest setting of particles that finds what touches.
const SearchResult* cheapest_sufficient(const CollisionStudy& study);

/// What follows, in sentences for people; each number in them is one of the study's.
std::vector<std::string> conclusions(const CollisionStudy& study);

struct CollisionStudyOptions {
  double seconds = 10.0;  // of the scene's time at most
  bool few = false;       // four settings in place of all
};

/// Throws scenes::SceneError for a scene with fewer than two soft bodies, DivergenceError and
/// Interrupted.
CollisionStudy study_collision(const scenes::Scene& scene, const CollisionStudyOptions& options);

}  // namespace pneuma::app
