#include "app/study/choices/drift.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/record/statistics.h"
#include "app/study/error/error_meter.h"
#include "app/study/error/samples.h"
#include "sim/mesh/measure.h"
#include "sim/soft/acceleration.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

using sim::PressureWeighting;
using sim::Vec3;

// ERRATA row 4 moves the vertices of a sphere of radius 3 by up to 0.4.
constexpr double perturbation_of_radius = 0.4 / 3.0;

/// Up to `amount` either way in each coordinate. The engine's output is the same everywhere, that
/// of the standard library's distributions is not.
void perturb(sim::SoftBody& body, double amount, int trial) {
  std::mt19937_64 engine(static_cast<std::uint64_t>(trial));
  const auto next = [&] { return amount * (static_cast<double>(engine() >> 11) * 0x1p-52 - 1.0); };
  for (int v = 0; v < body.positions.size(); ++v) {
    const double x = next(), y = next(), z = next();
    body.positions[v] += Vec3(x, y, z);
  }
}

/// The body at rest in its rest shape about the origin, so that digits are not lost to its place,
/// but for the perturbation.
sim::World free_world(sim::SoftBody body, PressureWeighting weighting, double perturbation,
                      int trial, int steps_per_second) {
  body.positions = body.mesh->rest_positions;
  body.velocities.rows().setZero();
  body.material.pressure_weighting = weighting;
  body.material.damping = sim::Damping::dashpot;
  perturb(body, perturbation, trial);
  sim::World world;
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.settings.integrator = sim::Integrator::rk4;
  world.settings.steps_per_second = steps_per_second;
  world.soft.push_back(std::move(body));
  return world;
}

/// The sum of all forces over the mean of their sizes.
double net_force(const sim::SoftBody& body) {
  sim::AccelerationScratch scratch(*body.mesh);
  const sim::SoftAcceleration equation(*body.mesh, body.material, Vec3::Zero(), scratch);
  sim::VertexArray acceleration(body.positions.size());
  equation(body.positions, body.velocities, acceleration);
  const double mean_size = acceleration.rows().colwise().norm().mean();
  return acceleration.rows().rowwise().sum().norm() / mean_size;
}

DriftTrial run_trial(sim::World world, double seconds) {
  DriftTrial trial;
  const double radius = rest_radius(world.soft[0]);
  trial.net_force = net_force(world.soft[0]);
  const Vec3 start = sim::mean(world.soft[0].positions);
  sim::Stepper stepper(world);
  const auto samples = static_cast<std::size_t>(std::lround(seconds * samples_per_second));
  const int steps = world.settings.steps_per_second / samples_per_second;
  while (trial.distances.size() < samples) {
    throw_if_interrupted();
    for (int i = 0; i < steps; ++i) {
      if (const auto divergence = stepper.step(world)) {
        throw DivergenceError(fmt::format("the drift of a free body at 1/{} s: {}",
                                          world.settings.steps_per_second, divergence->what));
      }
    }
    trial.distances.push_back((sim::mean(world.soft[0].positions) - start).norm() / radius);
  }
  return trial;
}

std::array<double, 3> range(std::vector<double> values) {
  std::ranges::sort(values);
  return {values.front(), percentile(values, 50.0), values.back()};
}

}  // namespace

DriftStudy study_drift(const sim::SoftBody& body, const DriftOptions& options) {
  DriftStudy study;
  study.seconds = options.seconds;
  study.perturbation = perturbation_of_radius * rest_radius(body);
  for (int trial = 1; trial <= options.trials; ++trial) {
    const auto run = [&](PressureWeighting weighting) {
      return run_trial(
          free_world(body, weighting, study.perturbation, trial, options.steps_per_second),
          options.seconds);
    };
    study.uniform.push_back(run(PressureWeighting::uniform));
    study.valence.push_back(run(PressureWeighting::valence));
  }
  return study;
}

std::array<double, 3> drift_range(const std::vector<DriftTrial>& trials) {
  std::vector<double> values;
  for (const DriftTrial& trial : trials) values.push_back(trial.distances.back());
  return range(std::move(values));
}

std::array<double, 3> force_range(const std::vector<DriftTrial>& trials) {
  std::vector<double> values;
  for (const DriftTrial& trial : trials) values.push_back(trial.net_force);
  return range(std::move(values));
}

std::string drift_sentence(const DriftStudy& study) {
  const auto valence = drift_range(study.valence);
  const auto force = force_range(study.valence);
  return fmt::format(
      "left to itself for {:g} s, the body moves by {:.2g} to {:.2g} (median {:.2g}) of its rest "
      "radius under valence, by {:.0e} at most under uniform; the net force inside it is at first "
      "{:.2g} to {:.2g} of that on a vertex under valence, {:.0e} at most under uniform",
      study.seconds, valence[0], valence[2], valence[1], drift_range(study.uniform)[2], force[0],
      force[2], force_range(study.uniform)[2]);
}

}  // namespace pneuma::app
