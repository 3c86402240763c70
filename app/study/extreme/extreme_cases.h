// Extreme scenes, as data, each with the outcome that was expected before it was run.
#pragma once

#include <string>
#include <vector>

namespace pneuma::app {

enum class Outcome {
  valid,     // finite, energy never above its start, volumes above zero, penetration bounded
  refused,   // with a message, before the first step
  diverged,  // found in the step where it happened, with a message
};

/// What a case does to its world before the first step: states that no scene file can ask for.
enum class ExtremeStart {
  as_made,
  flat,        // every vertex at its body's min. height: a volume of zero
  inside_out,  // mirrored: a volume below zero
  scattered,   // every vertex moved at random by up to its body's size
  one_point,   // all vertices of a body in one place
};

/// What no look at a run may find.
enum class Crossing {
  looked_for_nowhere,
  of_two_bodies,
  of_any_surface,  // with another's or itself
};

struct ExtremeCase {
  std::string name = {};
  std::string scene = {};  // TOML
  double seconds = 10.0;
  // What an explicit integrator may come to: one outcome, or two where its step decides.
  std::vector<Outcome> explicit_outcomes = {Outcome::valid};
  Outcome implicit_outcome = Outcome::valid;
  ExtremeStart start = ExtremeStart::as_made;
  // m, at most in the last half of the run: by default the skin. Infinite where bodies are known to
  // go deeper, which the table then shows.
  double penetration = 0.5;
  bool large = false;  // takes ten seconds and more
  // Energy above the start that is no fault, of the span of energy in the run: rounding, and what
  // contacts make that set a vertex back onto the ground by what it sank in one step (3.1.4).
  double energy_tolerance = 1e-3;
  Crossing may_not_cross = Crossing::looked_for_nowhere;
};

std::vector<ExtremeCase> extreme_cases();
/// Those of contact among them.
std::vector<ExtremeCase> impact_cases();

}  // namespace pneuma::app
