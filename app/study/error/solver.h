// The ways to compute a motion that are compared: our integrators at a step, SUNDIALS' at
// a tolerance.
#pragma once

#include <memory>
#include <string>

#include "app/study/error/samples.h"
#include "app/study/error/sundials.h"
#include "sim/step/stages/plan.h"

namespace pneuma::app {

/// From the start of a motion to its samples, one after the other.
class Solver {
 public:
  virtual ~Solver() = default;

  /// To the time of sample i, the next one. False when that failed.
  [[nodiscard]] virtual bool advance(std::size_t i) = 0;

  virtual Sample sample() const = 0;

  /// Why, and when, advance failed.
  virtual std::string failure() const = 0;
  /// Simulated time until then, s, above 0.
  virtual double failure_time() const = 0;

  /// Of the right-hand side so far; 0 when it does not count them.
  virtual long evaluations() const = 0;
};

/// The simulation itself, with the integrator and the step that the world's settings say: a
/// multiple of samples_per_second. Without `contacts` its plan leaves out every stage but the
/// motion.
std::unique_ptr<Solver> make_stepper_solver(sim::World world, bool contacts);

/// SUNDIALS on the simulation's own right-hand side, of the whole world with its contacts where
/// these are a potential, so that only the method differs. Its tolerance is relative to the rest
/// radius of each body and, for velocities, to that times the frequency of a vertex on a spring,
/// sqrt(k / m): neither the body's place nor its fall loosens it.
std::unique_ptr<Solver> make_peer_solver(const sim::World& world, SundialsMethod method,
                                         double tolerance);

/// CVODE's Adams method on the right-hand side of a world whose contacts are a potential. Its steps
/// cross nothing: a state beyond a crossing has no meaning to it, and it tries a shorter step.
std::unique_ptr<Solver> make_contact_reference_solver(const sim::World& world, double tolerance);

/// CVODE's Adams method on the equation written down again.
std::unique_ptr<Solver> make_reference_solver(const sim::World& world, double tolerance);

}  // namespace pneuma::app
