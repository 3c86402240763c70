#include "app/study/error/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/study/error/error_meter.h"

namespace pneuma::app {
namespace {

constexpr double reference_tolerance = 1e-12;
constexpr double check_tolerance = 1e-13;

// Of the rest radius. Far below any error that is of use, far above rounding.
constexpr double smooth_agreement = 1e-9;
// An error of 1e-2 is then known to a tenth.
constexpr double contact_agreement = 1e-3;
// Of contact as a potential, whose force is continuous: an error of 1e-4 is known to a tenth.
constexpr double potential_agreement = 1e-5;
constexpr double potential_tolerance = 1e-11;
constexpr double potential_check_tolerance = 1e-10;

/// Two runs that should be the same, the better one first.
struct Runs {
  std::unique_ptr<Solver> best;
  std::unique_ptr<Solver> second;
  double agreement;
};

Runs smooth_runs(const Flight& flight) {
  return {make_reference_solver(flight.world, reference_tolerance),
          make_reference_solver(flight.world, check_tolerance), smooth_agreement};
}

Runs contact_runs(const Flight& flight, int finest) {
  sim::World world = flight.world;
  world.settings.integrator = sim::Integrator::rk4;
  world.settings.steps_per_second = 2 * finest;
  auto best = make_stepper_solver(world, true);
  world.settings.steps_per_second = finest;
  return {std::move(best), make_stepper_solver(world, true), contact_agreement};
}

bool is_by_potential(const Flight& flight) {
  return flight.contacts && flight.world.settings.contact == sim::ContactMethod::potential;
}

Runs potential_runs(const Flight& flight) {
  return {make_contact_reference_solver(flight.world, potential_tolerance),
          make_contact_reference_solver(flight.world, potential_check_tolerance),
          potential_agreement};
}

std::string method(const Flight& flight, int finest) {
  if (is_by_potential(flight)) {
    return fmt::format(
        "CVODE's Adams method at tolerance {:.0e} on the same equation, contact included, as far "
        "as that at {:.0e} agrees within {:.0e}",
        potential_tolerance, potential_check_tolerance, potential_agreement);
  }
  if (flight.contacts) {
    return fmt::format("our own rk4 at 1/{} s, as far as that at 1/{} s agrees within {:.0e}",
                       2 * finest, finest, contact_agreement);
  }
  return fmt::format(
      "CVODE's Adams method at tolerance {:.0e} on the equation written down again, "
      "as far as that at {:.0e} agrees within {:.0e}",
      reference_tolerance, check_tolerance, smooth_agreement);
}

std::string limit(const Flight& flight) {
  if (is_by_potential(flight)) {
    return "from then on the smallest difference grows into another motion: contacts and buckling "
           "are chaotic, and no method can follow";
  }
  return flight.contacts
             ? "from then on the two finest runs part; contacts are not smooth, and a small "
               "difference can decide which feature touches first"
             : "from then on the smallest difference grows into another motion, as when a body "
               "buckles, and no method can follow";
}

std::string nothing_known(const Runs& runs) {
  for (const auto& solver : {&runs.best, &runs.second}) {
    if (const std::string failure = (*solver)->failure(); !failure.empty()) {
      return fmt::format("no motion to compare with: one of the two finest runs failed {}",
                         failure);
    }
  }
  return fmt::format(
      "no motion to compare with: in the first {:.4g} s the two finest runs already "
      "differ by more than {:.0e} of the rest radius",
      sample_time(0), runs.agreement);
}

}  // namespace

Trajectory follow(Solver& solver, std::size_t samples) {
  Trajectory trajectory;
  while (trajectory.size() < samples && solver.advance(trajectory.size())) {
    throw_if_interrupted();
    trajectory.push_back(solver.sample());
  }
  return trajectory;
}

Reference make_reference(const Flight& flight, int finest_steps_per_second) {
  const auto samples = static_cast<std::size_t>(std::lround(flight.seconds * samples_per_second));
  const Runs runs = is_by_potential(flight) ? potential_runs(flight)
                    : flight.contacts       ? contact_runs(flight, finest_steps_per_second)
                                            : smooth_runs(flight);
  Reference reference;
  reference.method = method(flight, finest_steps_per_second);
  reference.trajectory = follow(*runs.best, samples);
  const Trajectory second = follow(*runs.second, reference.trajectory.size());

  std::size_t known = 0;
  if (!second.empty()) {
    ErrorMeter meter(flight.world, reference.trajectory);
    for (; known < second.size(); ++known) {
      const double difference = meter.errors(known, second[known]).position;
      if (!(difference <= runs.agreement)) break;
      reference.uncertainty = std::max(reference.uncertainty, difference);
    }
  }
  if (known == 0) throw DivergenceError(nothing_known(runs));
  reference.trajectory.resize(known);
  reference.seconds = sample_time(known - 1);
  if (known < samples) reference.limit = limit(flight);
  return reference;
}

}  // namespace pneuma::app
