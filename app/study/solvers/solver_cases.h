// What `pneuma study solvers` compares solvers on: one body, as a coarse and as a fine mesh, that
// is blown up from rest or tumbles.
#pragma once

#include <string>
#include <vector>

#include "app/study/error/error_study.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

struct SolverCase {
  int vertices = 0;
  scenes::Scene scene;
  ErrorOptions options;
};

/// Spheres of 58 to 10,242 vertices, each with both motions, in free flight. `few`: the coarsest
/// alone, and fewer steps and tolerances.
std::vector<SolverCase> solver_cases(bool few);

}  // namespace pneuma::app
