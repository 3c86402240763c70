// The error of a motion against a reference.
#pragma once

#include <vector>

#include "app/study/error/samples.h"
#include "sim/inspect/inspect.h"

namespace pneuma::app {

/// All relative, 0 and up.
struct StateErrors {
  double position = 0.0;  // root mean square over all vertices (of boxes: the corners) of the
                          // distance, each divided by its body's rest radius
  double volume = 0.0;    // of the worst body, of its volume
  double centre = 0.0;    // of the worst body's centre of mass, divided by its rest radius
  double energy = 0.0;    // of the total, divided by the reference's max. kinetic energy
  double momentum = 0.0;  // of the total, divided by the momentum that the whole mass would have
                          // with that kinetic energy
  double angular_momentum = 0.0;  // of the total, about the reference's centre of mass, divided by
                                  // that momentum times the greatest rest radius
};

struct RunErrors {
  StateErrors end;       // at the last sample
  StateErrors greatest;  // of each kind, over all samples
};

/// The max. distance in metres of a vertex from the mean of all, in the rest shape.
double rest_radius(const sim::SoftBody& body);

class ErrorMeter {
 public:
  /// `world` gives meshes, materials and gravity; its state is not used. `reference` is not empty.
  ErrorMeter(sim::World world, const Trajectory& reference);

  /// At sample i of the reference.
  StateErrors errors(std::size_t i, const Sample& sample);

  /// Of all of the reference's samples; the trajectory has as many or more.
  RunErrors errors(const Trajectory& trajectory);

  std::size_t size() const { return reference_.size(); }

 private:
  struct Observed {
    Sample sample;
    std::vector<double> volumes;     // m^3, per soft body
    std::vector<sim::Vec3> centres;  // m, per soft body, then per box
    double energy = 0.0;             // J
    double kinetic = 0.0;            // J
    sim::Momentum momentum;
  };
  Observed observe(const Sample& sample);
  sim::Vec3 centre_of_mass(const Observed& observed) const;
  double position_error(const Sample& sample, const Sample& reference) const;

  sim::World world_;
  std::vector<double> radii_;   // m, per soft body, then per box
  std::vector<double> masses_;  // kg, likewise
  std::vector<Observed> reference_;
  double energy_scale_ = 0.0;    // J
  double momentum_scale_ = 0.0;  // kg m/s
};

}  // namespace pneuma::app
