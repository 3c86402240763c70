// The part of `pneuma study stability` that is about contact as a potential: the longest stable
// step of what lies on the ground and carries a load, found by trying, beside the one that theory
// predicts (sim/potential/world_vibration.h).
//
// The first soft body of a scene lies on the ground, alone or under a plate, and has come to rest.
// Two copies of it, one of which is moved by next to nothing, are stepped by each explicit
// integrator alone: a step is unstable with which they part. Theory knows how stiff friction is at
// rest, but nothing of restitution, which acts on what parts: these copies have a restitution of 1.
// What friction holds creeps, below the regularisation speed, and friction is less stiff then than
// at rest: the predicted step is then shorter than the one that is found.
//
// The program's own steps are divided where a barrier is too stiff for them. How often that is, and
// how fast its surface still trembles, is measured besides, likewise by the implicit integrators:
// friction and restitution are stiff only up to the regularisation speed, so that what trembles by
// them does so about as fast as a step lets their greatest force push.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/study/stability/trial.h"
#include "scenes/loader/scene.h"

namespace pneuma::app {

/// What the program's own steps do with it, disturbed.
struct OwnSteps {
  int steps_per_second = 60;
  std::string failure = {};  // what a divergence was; empty: none
  double parts = 1.0;        // a step is divided into, on average
  double trembling = 0.0;    // m/s: the greatest speed of a vertex in the last half
};

struct ContactStabilityPoint {
  sim::Integrator integrator;
  std::string varied;  // "contact stiffness", "friction", "mass ratio"
  double value = 0.0;  // stiffness: of the default one; mass ratio: of the plate over the body
  std::optional<double> stable_step = {};     // s, of the integrator alone; nothing: none was found
  std::optional<double> predicted_step = {};  // s; nothing: no limit by theory
  std::vector<OwnSteps> own = {};             // for each of the options' rates
};

struct ContactStabilityOptions {
  std::vector<double> stiffness, friction, mass_ratio;
  std::vector<int> rates;  // steps/s of the program's own steps
  double seconds = 1.0;    // of these
};
ContactStabilityOptions full_contact_sweep();
ContactStabilityOptions short_contact_sweep();

/// `say` is told what is being tried. Throws UsageError for a scene without a soft body,
/// scenes::SceneError and Interrupted.
std::vector<ContactStabilityPoint> study_contact_stability(
    const scenes::Scene& scene, const ContactStabilityOptions& options,
    const std::function<void(const std::string&)>& say);

/// A world whose first soft body lies on the ground, by potential, under a plate of so many times
/// its mass (0: none), and has come to rest; its pressure is `uniform` and its damping `dashpot`,
/// as contact by potential needs them. `stiffness`: of the default one. Throws UsageError when it
/// does not come to rest.
sim::World lying_body(const sim::Settings& settings, sim::SoftBody body, double stiffness,
                      double friction, double mass_ratio);

/// The longest step with which two motions do not part, to 1 %, looked for about `predicted`.
std::optional<double> find_stable_contact_step(const sim::World& at_rest, double predicted);

std::string contact_stability_text(const std::string& scene,
                                   const std::vector<ContactStabilityPoint>& points);
std::string contact_stability_csv(const std::vector<ContactStabilityPoint>& points);

}  // namespace pneuma::app
