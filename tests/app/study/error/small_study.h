// What the tests of the error study start from.
#pragma once

#include <string>

#include "app/study/error/error_study.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {

/// The paper's sphere high above the ground.
inline scenes::Scene small_scene_with(const std::string& material) {
  return scenes::parse_scene(
      "title = \"A small scene\"\nduration = 1.0\n[[body]]\nname = \"ball\"\n"
      "position = [0, 0, 50]\n" +
          material,
      "small.toml");
}

/// It swells and swings.
inline scenes::Scene small_scene(const std::string& more = "") {
  return small_scene_with("k = 50.0\nn = 5.0\n" + more);
}

inline sim::World small_world(const std::string& more = "") {
  FlightOptions options;
  options.seconds = 0.2;
  return prepare_flight(small_scene(more), options).world;
}

/// A run as if it had been measured.
inline ErrorRun made_up_run(const std::string& method, int steps_per_second, double error,
                            double run_time) {
  ErrorRun run;
  run.method = method;
  run.steps_per_second = steps_per_second;
  run.run_time = run_time;
  run.errors.greatest.position = error;
  run.errors.end.position = 0.5 * error;
  return run;
}

inline ErrorRun made_up_peer_run(double tolerance, double error, double run_time,
                                 double evaluations) {
  ErrorRun run = made_up_run("cvode_adams", 0, error, run_time);
  run.ours = false;
  run.tolerance = tolerance;
  run.evaluations = evaluations;
  return run;
}

inline ErrorRun made_up_unstable_run(const std::string& method, int steps_per_second) {
  ErrorRun run = made_up_run(method, steps_per_second, 0.0, 1e-4);
  run.status = ErrorRun::Status::unstable;
  run.failure = "at 0.1 s: gone, and \"how\"";
  return run;
}

/// Without runs.
inline ErrorStudy made_up_study() {
  ErrorStudy study;
  study.name = "made_up";
  study.title = "Made up";
  study.flight.seconds = 1.0;
  study.flight.description = "free flight";
  study.reference.seconds = 1.0;
  study.reference.method = "nothing";
  study.rest_radius = 3.0;
  study.vertices = 58;
  study.evaluation_time = 2e-6;
  return study;
}

}  // namespace pneuma::app
