// What holds for a whole world.
// Units: metre, kilogram, second, kelvin, mole.
#pragma once

#include <cstdint>
#include <optional>

#include "sim/mesh/triangle_mesh.h"
#include "sim/world/contact_material.h"
#include "sim/world/soft_body.h"

namespace pneuma::sim {

/// ERRATA rows 7 and 32. The last two are implicit: sim/soft/implicit_step.h.
enum class Integrator {
  martin,
  symplectic_euler,
  velocity_verlet,
  rk4,
  rk8,
  implicit_euler,
  sdirk2
};

inline bool is_implicit(Integrator integrator) {
  return integrator == Integrator::implicit_euler || integrator == Integrator::sdirk2;
}
/// Implicit integrators minimise an energy, and `valence` pressure is not the force of one.
inline bool can_integrate(Integrator integrator, const SoftMaterial& material) {
  return !is_implicit(integrator) || material.pressure_weighting == PressureWeighting::uniform;
}

/// How contacts of two soft bodies are searched for (ERRATA row 45).
enum class SoftSearch {
  particles,  // the paper's: collision particles that walk over the surfaces (5.2.1)
  exact,      // everything within reach, over a spatial subdivision (sim/collision/find_exact.h)
};

/// How bodies in contact are kept apart.
enum class ContactMethod {
  impulses,   // the paper's: found after the motion, then impulses and displacements (5.3)
  swept,      // found before anything passes through a soft body (ERRATA row 67)
  potential,  // a term of the equation of motion (ERRATA row 73, sim/potential/contact_potential.h)
};

/// Of contact as a potential.
struct PotentialSettings {
  // m, from which on surfaces push each other, and at most a twentieth of an edge.
  double distance = 0.1;
  std::optional<double> stiffness;     // Pa; none: default_stiffness
  double regularisation_speed = 0.02;  // m/s, at which friction and restitution act in full
};

/// Whose form of the paper's formulas a world follows (ERRATA row 68).
enum class Method {
  corrected,  // as ERRATA reads and corrects them; where there is a choice, as it is made
  paper,      // as printed, every choice included: use_paper_method
};

/// Section 5.2.1's numbers, with the paper's values as defaults.
struct ParticleSettings {
  double per_vertex = 1.0 / 8.0;  // particles per vertex of a body, at least one per body
  double attraction = 2.0;  // of the other body's particles, in units of the own ones' repulsion
  int max_sweeps = 10;      // of the refinement loop per step
  int settled_below = 4;    // the loop ends when fewer than this many particles move
  bool shown = false;       // they walk to be looked at, also where contacts are found without them
};

struct Settings {
  Method method = Method::corrected;  // set by use_paper_method, with all that belongs to it
  int steps_per_second = 60;  // the step is its inverse, so that time is exact at whole seconds
  Integrator integrator = Integrator::rk4;
  Vec3 gravity = {0.0, 0.0, -9.81};  // m/s^2
  std::optional<ContactMaterial> ground =
      ContactMaterial{};  // the plane z = 0; none: bodies fall for ever
  ContactMethod contact = ContactMethod::swept;
  // m; features nearer than twice this are in contact (5.2.1.1). Swept contacts keep at most twice
  // this, and no more than a fiftieth of an edge.
  double skin_thickness = 0.5;
  SoftSearch soft_search = SoftSearch::particles;
  PotentialSettings potential;
  ParticleSettings particles;
  double relaxation_time = 0.1;  // s in which soft features that overlap part by a factor e;
                                 // 0: at once, as in the paper (ERRATA row 61)
  // Gauss-Seidel iterations over the contacts of an island; at most 3 where no box rests on another
  // or on the ground (ERRATA row 57). Where anything bounces, as many again (ERRATA row 56).
  int contact_iterations = 10;
  // m/s; bodies that touch each other or what stands still leave the step when none of them has
  // been faster, or left its place, for a while (ERRATA row 71); 0: none does. Of swept contacts.
  double sleep_speed = 0.01;
  std::uint64_t seed = 1;  // of the particles' start features (ERRATA row 40)
};

inline bool is_as_printed(const Settings& settings) { return settings.method == Method::paper; }

inline double time_step(const Settings& settings) { return 1.0 / settings.steps_per_second; }

}  // namespace pneuma::sim
