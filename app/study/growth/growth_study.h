// `pneuma study growth`: how the time of a step, and of a simulated second, grows with the size of
// a scene.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/study/diagram.h"
#include "app/study/power_law.h"

namespace pneuma::app {

struct GrowthPoint {
  double size = 0.0;          // of what is varied
  double step_seconds = 0.0;  // the processor's, median of a step: whatever else the machine does
  int steps_per_second = 60;  // as many as this size needs

  /// The processor's, for a second of the scene's.
  double seconds_per_second() const { return step_seconds * steps_per_second; }
};

/// One kind of scene in several sizes.
struct GrowthSeries {
  std::string name;  // "bodies"
  std::vector<GrowthPoint> points;
  // Over size; an exponent of 1 is in proportion.
  PowerLaw step;    // of step_seconds
  PowerLaw second;  // of seconds_per_second()
};

struct GrowthOptions {
  bool few = false;                // small sizes only
  double seconds_per_point = 1.0;  // of measuring, and never less than one run
};

/// Vertices of one icosphere on the ground and of two that meet, by swept contacts and by the
/// contact potential, soft spheres side by side on the ground, stacks of five cubes. Of each the
/// same part of its motion, again and again. Throws DivergenceError and Interrupted.
std::vector<GrowthSeries> study_growth(const GrowthOptions& options,
                                       const std::function<void(const std::string&)>& say);

/// All series: time of a simulated second over size, over size.
Diagram growth_diagram(const std::vector<GrowthSeries>& series);

}  // namespace pneuma::app
