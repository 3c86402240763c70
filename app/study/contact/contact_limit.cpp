#include "app/study/contact/contact_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/host/clock.h"
#include "app/host/errors.h"
#include "app/study/error/error_meter.h"

namespace pneuma::app {
namespace {

// An error of 1e-2 is then known to a tenth.
constexpr double limit_agreement = 1e-3;
// Far below the agreement.
constexpr double limit_tolerance = 1e-9;
constexpr std::size_t least_motions = 3;

/// 2 b - a, of all but the sizes.
Sample extrapolate(const Sample& a, const Sample& b) {
  Sample limit = b;
  for (std::size_t i = 0; i < b.soft.size(); ++i) {
    limit.soft[i].positions.rows() += b.soft[i].positions.rows() - a.soft[i].positions.rows();
    limit.soft[i].velocities.rows() += b.soft[i].velocities.rows() - a.soft[i].velocities.rows();
  }
  for (std::size_t i = 0; i < b.rigid.size(); ++i) {
    const sim::RigidBox& from = a.rigid[i];
    sim::RigidBox& box = limit.rigid[i];
    box.position += box.position - from.position;
    box.velocity += box.velocity - from.velocity;
    box.angular_velocity += box.angular_velocity - from.angular_velocity;
    box.orientation = box.orientation * from.orientation.conjugate() * box.orientation;
  }
  return limit;
}

Trajectory extrapolate(const Trajectory& a, const Trajectory& b) {
  Trajectory limit;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    limit.push_back(extrapolate(a[i], b[i]));
  }
  return limit;
}

double max_error(const Flight& flight, const Trajectory& motion, const Trajectory& limit) {
  ErrorMeter meter(flight.world, limit);
  double most = 0.0;
  for (std::size_t i = 0; i < std::min(motion.size(), limit.size()); ++i) {
    most = std::max(most, meter.errors(i, motion[i]).position);
  }
  return most;
}

/// Of all distances, from long to short, until one takes too long or fails.
std::vector<Trajectory> motions(const Flight& flight, const LimitOptions& options,
                                const std::function<void(const std::string&)>& say,
                                std::vector<double>& distances) {
  const auto samples = static_cast<std::size_t>(std::lround(flight.seconds * samples_per_second));
  std::vector<Trajectory> all;
  for (int i = 0; i <= options.halvings; ++i) {
    sim::World world = flight.world;
    double& distance = world.settings.potential.distance;
    distance = std::ldexp(distance, -i);
    say(fmt::format("the potential at {:.3g} m", distance));
    const double start = thread_seconds();
    const auto solver = make_contact_reference_solver(world, limit_tolerance);
    Trajectory motion = follow(*solver, samples);
    if (motion.size() < samples) break;
    distances.push_back(distance);
    all.push_back(std::move(motion));
    const bool are_enough = all.size() >= least_motions;
    if (are_enough && thread_seconds() - start > options.longest_run) break;
  }
  return all;
}

/// As far as the two limits agree.
void keep_what_is_known(const Flight& flight, const Trajectory& second, Reference& reference) {
  ErrorMeter meter(flight.world, reference.trajectory);
  std::size_t known = 0;
  for (; known < second.size(); ++known) {
    const double difference = meter.errors(known, second[known]).position;
    if (!(difference <= limit_agreement)) break;
    reference.uncertainty = std::max(reference.uncertainty, difference);
  }
  if (known == 0) {
    throw DivergenceError(fmt::format(
        "no motion to compare with: in the first {:.4g} s the limits of the contact potential "
        "already differ by more than {:.0e} of the rest radius",
        sample_time(0), limit_agreement));
  }
  if (known < second.size()) {
    reference.limit = "from then on the limits of the contact potential part";
  }
  reference.trajectory.resize(known);
  reference.seconds = sample_time(known - 1);
}

}  // namespace

ContactLimit find_contact_limit(const Flight& flight, const LimitOptions& options,
                                const std::function<void(const std::string&)>& say) {
  ContactLimit found;
  const std::vector<Trajectory> all = motions(flight, options, say, found.distances);
  if (all.size() < least_motions) {
    throw DivergenceError(fmt::format(
        "no motion to compare with: CVODE follows the contact potential at {} distances, and the "
        "limit takes {}",
        all.size(), least_motions));
  }
  const std::size_t last = all.size() - 1;
  Reference& reference = found.reference;
  reference.method = fmt::format(
      "the limit of the contact potential (CVODE's Adams method at tolerance {:.0e}, distances "
      "from {:.3g} to {:.3g} m, extrapolated to 0), as far as that of one distance less agrees "
      "within {:.0e}",
      limit_tolerance, found.distances.front(), found.distances.back(), limit_agreement);
  reference.trajectory = extrapolate(all[last - 1], all[last]);
  keep_what_is_known(flight, extrapolate(all[last - 2], all[last - 1]), reference);
  for (const Trajectory& motion : all) {
    found.errors.push_back(max_error(flight, motion, reference.trajectory));
  }
  return found;
}

}  // namespace pneuma::app
