// What of a scene an error study runs: which bodies, and whether anything touches.
#pragma once

#include <optional>
#include <string>

#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

struct FlightOptions {
  std::string body;          // only this one; empty: all
  bool free_flight = false;  // without ground, boxes, obstacles and contacts
  /// Soft bodies start with spin, shear and slack springs: nine tenths as large as their scene has
  /// them, with 3 rad/s about (1, 1, 1) and du/dz = 2/s added to their velocities.
  bool tumbling = false;
  double seconds = 1.0;  // simulated, at most as long as the scene
  /// The command has --body and --free-flight, so that messages may name them.
  bool are_options = false;
};

struct Flight {
  sim::World world;  // at time 0
  /// Contacts are looked for and resolved. Without, every soft body moves by itself, by the
  /// model's differential equation: a smooth motion with a reference.
  bool contacts = false;
  double seconds = 0.0;  // a whole number of samples
  /// s, when something first touches, if it does so in the time: by short steps of rk4. A run that
  /// diverges before is said to touch then.
  std::optional<double> first_contact;
  std::string description;  // "free flight (nothing touches in this time)"
};

/// s, down to a whole number of samples, at least one.
double whole_samples(double seconds);

/// Asked for or not, a world in which nothing touches in the time is in free flight. Throws
/// UsageError for a body that is not there, when nothing is left that could have an error, for a
/// pinned body or an obstacle of triangles, and for `literal` damping, which is no differential
/// equation; and scenes::SceneError.
Flight prepare_flight(const scenes::Scene& scene, const FlightOptions& options);

/// The most contacts that a step has in the first `seconds` of a flight, by the steps that
/// first_contact is found by; of a run that diverges, until then.
int max_contacts(const Flight& flight, double seconds);

}  // namespace pneuma::app
