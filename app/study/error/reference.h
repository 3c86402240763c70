// The motion that errors are measured against, as far as it is known.
#pragma once

#include <string>

#include "app/study/error/flight.h"
#include "app/study/error/samples.h"
#include "app/study/error/solver.h"

namespace pneuma::app {

struct Reference {
  Trajectory trajectory;     // until `seconds`
  double seconds = 0.0;      // for so long it is known; a whole number of samples
  double uncertainty = 0.0;  // how well: the max. position error of the second-best run
  std::string method;        // "CVODE's Adams method at tolerance 1e-12 ..."
  std::string limit;         // why it is known no longer than that; empty when it is all the time
};

/// As many samples as it gets, at most so many. Throws Interrupted.
Trajectory follow(Solver& solver, std::size_t samples);

/// In free flight: CVODE at tolerance 1e-12 on the equation written down again, as far as a run at
/// 1e-13 agrees with it within 1e-9. With contacts, whose motion is not smooth: our own rk4 at
/// twice `finest_steps_per_second`, as far as one at that rate agrees with it within 1e-3. With
/// contact as a potential: CVODE at 1e-11, and at 1e-10 within 1e-5. Throws
/// DivergenceError when not even one sample is known.
Reference make_reference(const Flight& flight, int finest_steps_per_second);

}  // namespace pneuma::app
