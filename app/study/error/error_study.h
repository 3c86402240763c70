// Error against run time of one scene: every integrator over the steps, those of
// SUNDIALS over their tolerances.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/study/error/error_meter.h"
#include "app/study/error/flight.h"
#include "app/study/error/reference.h"

namespace pneuma::app {

struct ErrorOptions {
  FlightOptions flight;
  std::vector<int> steps_per_second;  // ascending, multiples of samples_per_second, not empty
  std::vector<double> tolerances;     // of SUNDIALS, from loose to tight
  std::vector<sim::Integrator> integrators;  // of ours; empty: all
  double finest_error = 0.0;                 // no shorter steps after a run with an error below
  int repeats = 5;                           // of each run, for its time
  /// s of processor time: a method is not taken to shorter steps (or tighter tolerances) after a
  /// run that took longer than this, and the runs of a repetition are not repeated beyond it.
  double longest_run = 20.0;
};

/// The steps from 1/15 s to 1/7680 s, and tolerances from 1e-1 to 1e-9 by half powers of ten.
ErrorOptions full_sweep();
/// In seconds: to see that all of it works, and for CI.
ErrorOptions short_sweep();

/// One method at one step or tolerance.
struct ErrorRun {
  enum class Status {
    stable,
    unstable,  // diverged, or further off than ten rest radii
    skipped,   // would take too long, or is not needed
  };

  std::string method;
  bool ours = true;          // else SUNDIALS'
  int steps_per_second = 0;  // ours
  double tolerance = 0.0;    // SUNDIALS'
  Status status = Status::stable;
  std::string failure;       // of an unstable or skipped one: what, and when
  double run_time = 0.0;     // s of processor time per simulated second, min. of the repeats
  double evaluations = 0.0;  // of the right-hand side per simulated second; 0: not counted
  RunErrors errors;          // of a stable one

  /// s; ours.
  double step() const { return 1.0 / steps_per_second; }
};

/// The error of a run that conclusions are drawn from: of position, max. over time.
inline double error_of(const ErrorRun& run) { return run.errors.greatest.position; }

/// "stable", ...
std::string_view to_string(ErrorRun::Status status);

struct ErrorStudy {
  std::string name;  // of the scene, with the body when there is only one of several
  std::string title;
  Flight flight;
  Reference reference;
  double rest_radius = 0.0;      // m, of the first body
  int vertices = 0;              // of all soft bodies
  double evaluation_time = 0.0;  // s of one evaluation of the right-hand side of all bodies
  std::vector<ErrorRun> runs;    // method by method, from coarse to fine
};

/// ErrorStudy::name. `body`: the only one that is studied; empty: all.
std::string study_name(const scenes::Scene& scene, const std::string& body);

/// Time of one evaluation of the forces on all soft bodies of a world, s, the min. of many.
double measure_evaluation(const sim::World& world);

/// m.
double radius_of_first_body(const sim::World& world);

/// Of every integrator, then of SUNDIALS where it knows the flight's equation; by the paper's
/// method of its own integrator. Against the meter's reference.
std::vector<ErrorRun> measure_runs(const Flight& flight, ErrorMeter& meter,
                                   const ErrorOptions& options,
                                   const std::function<void(const std::string&)>& say);

/// Throws UsageError and DivergenceError (see flight.h, reference.h), scenes::SceneError and
/// Interrupted. `say` is told what is being done.
ErrorStudy study_errors(const scenes::Scene& scene, const ErrorOptions& options,
                        const std::function<void(const std::string&)>& say);

}  // namespace pneuma::app
