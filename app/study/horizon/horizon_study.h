// How a small difference at the start of a scene grows, and so for how long its motion can be told:
// where contacts and buckling make it chaotic, no method can follow it for longer.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/study/diagram.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

struct HorizonOptions {
  double difference = 1e-9;       // of the rest radius, root mean square over the vertices
  int tries = 3;                  // with other differences each
  std::optional<double> seconds;  // simulated, at most the scene's own
};

/// A difference between two runs, of the rest radius, root mean square over the vertices (of boxes:
/// the corners).
struct Difference {
  double time = 0.0;  // s
  double size = 0.0;  // the median of the tries
};

struct Horizon {
  std::string name;  // of the scene
  double start = 0.0;
  std::vector<Difference> differences;  // fifteen a second
  double growth_rate = 0.0;             // 1/s, as fit_growth has it

  /// s, when it is first above that; nothing if it never is.
  std::optional<double> exceeds(double size) const;
};

/// 1/s, by which the logarithm of a difference grows: the slope of a straight line through all, by
/// least squares, as far as they are small beside a rest radius. Below zero where motions meet
/// again. Not a number where fewer than three are.
double fit_growth(const std::vector<Difference>& differences);

/// The sizes that are told of in tables.
inline constexpr double told_sizes[] = {1e-6, 1e-3, 1e-2};

/// Throws DivergenceError, scenes::SceneError and Interrupted.
Horizon study_horizon(const scenes::Scene& scene, const HorizonOptions& options,
                      const std::function<void(const std::string&)>& say);

/// Differences over time, a line for each scene.
Diagram horizon_diagram(const std::vector<Horizon>& horizons);

}  // namespace pneuma::app
