// The state of a simulation as plain data: bodies and settings, no algorithms.
// Units: metre, kilogram, second, kelvin, mole. Right-handed, +z up, ground at z = 0.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/soft/soft_mesh.h"

namespace pneuma::sim {

/// J/(mol K); the value of the author's program.
inline constexpr double gas_constant = 8.314472;

/// The last two are implicit: sim/soft/implicit_step.h.
enum class Integrator { martin, symplectic_euler, velocity_verlet, rk4, implicit_euler, sdirk2 };

/// How triangle pressure forces reach the vertices (ERRATA row 4).
enum class PressureWeighting {
  uniform,  // exactly P dV/dx: conservative, no net force
  valence,  // the paper's springs / average springs: a free body propels itself
};

/// ERRATA row 5.
enum class Damping {
  dashpot,  // a continuous model: drag on the velocity, dashpots along the springs
  literal,  // the paper's v' = v - rho v in every step, whatever its length
};

/// What a surface does in a contact. Of two surfaces, the pair takes the greater restitution and
/// the geometric mean of the frictions.
struct Surface {
  double restitution = 0.2;  // 0..1; 0 keeps no normal velocity
  double friction = 0.5;     // Coulomb mu, >= 0
};

/// Section 3.1's constants of one body.
struct SoftMaterial {
  double k = 50.0;              // spring constant, N/m, >= 0
  double n = 10.0;              // amount of gas, mol, >= 0; 0 is an empty membrane
  double temperature = 293.15;  // K, >= 0
  double vertex_mass = 0.35;    // kg, > 0
  PressureWeighting pressure = PressureWeighting::uniform;
  Damping damping = Damping::dashpot;
  double rho_g = 0.01;   // share of velocity lost per 1/60 s, 0 <= rho_g < 1
  double k_max = 400.0;  // N/m; springs at or beyond it are damped as much as is ever done
  Surface surface;
};

struct SoftBody {
  std::string name;
  std::shared_ptr<const SoftMesh> mesh;
  SoftMaterial material;
  VertexArray positions;   // m
  VertexArray velocities;  // m/s
};

/// A box of uniform density (section 4).
struct RigidBox {
  std::string name;
  Vec3 size = Vec3::Ones();  // full lengths along body x, y, z: the paper's width, height, depth, m
  double mass = 1.0;         // kg
  double rho_g = 0.01;       // share of both velocities lost per 1/60 s, 0 <= rho_g < 1 (3.1.3)
  Surface surface;
  Vec3 position = Vec3::Zero();                                     // centre of mass, m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // body to world
  Vec3 velocity = Vec3::Zero();                                     // m/s
  Vec3 angular_velocity = Vec3::Zero();                             // rad/s, world axes
};

/// How contacts of two soft bodies are searched for.
enum class SoftSearch {
  particles,  // the paper's: collision particles that walk over the surfaces (5.2.1)
  exact,      // everything within reach, over a spatial subdivision (sim/collision/find_exact.h)
};

/// Section 5.2.1's numbers, with the paper's values as defaults.
struct ParticleSettings {
  double per_vertex = 1.0 / 8.0;  // particles per vertex of a body, at least one per body
  double attraction = 2.0;  // of the other body's particles, in units of the own ones' repulsion
  int max_sweeps = 10;      // of the refinement loop per step
  int settled_below = 4;    // the loop ends when fewer than this many particles move
};

struct Settings {
  int steps_per_second = 60;  // the step is its inverse, so that time is exact at whole seconds
  Integrator integrator = Integrator::rk4;
  Vec3 gravity = {0.0, 0.0, -9.81};           // m/s^2
  std::optional<Surface> ground = Surface{};  // the plane z = 0; none: bodies fall for ever
  double skin_thickness = 0.5;  // m; features nearer than twice this are in contact (5.2.1.1)
  SoftSearch soft_search = SoftSearch::particles;
  ParticleSettings particles;
  double separation_time = 0.1;  // s in which soft features that overlap part by a factor e;
                                 // 0: at once, as in the paper (5.3.1)
  int impulse_sweeps = 10;  // over the contacts of a step that hang together; at most 3 where no
                            // box rests on another or on the ground
  std::uint64_t seed = 1;   // of the particles' start features
};

/// What held one point of a box in the last step, from which the next step's impulses start. A
/// stack of boxes stands only if they are known beforehand, so they are state.
struct RestingImpulse {
  int first = 0;                // box
  int second = 0;               // box, or -1 for the ground
  Vec3 place = Vec3::Zero();    // where it acts, in the first box's own axes, m from its centre
  Vec3 impulse = Vec3::Zero();  // on the first box, N s; the second gets the opposite
};

/// The collision particles of one pair of soft bodies: the features they rest on, first < second.
/// They persist from step to step, so they are state.
struct ParticlePair {
  int first = 0;
  int second = 0;
  std::vector<int> first_features;   // feature ids on `first`
  std::vector<int> second_features;  // feature ids on `second`
  bool near = false;                 // in the last step they might have touched
};

/// Two soft bodies that were deep in each other, and are not yet clear of each other, first <
/// second (sim/collision/deep_pair.h). What begins at one depth and ends at another is state.
struct PartingPair {
  int first = 0;
  int second = 0;
};

struct World {
  Settings settings;
  std::vector<SoftBody> soft;
  std::vector<RigidBox> rigid;
  std::vector<ParticlePair> particles;  // pairs that have met, ordered by (first, second)
  std::vector<RestingImpulse>
      resting_impulses;              // of the last step, ground first, then by (first, second)
  std::vector<PartingPair> parting;  // ordered by (first, second)
  std::int64_t steps = 0;            // done so far; time is steps / steps_per_second
};

inline bool is_implicit(Integrator integrator) {
  return integrator == Integrator::implicit_euler || integrator == Integrator::sdirk2;
}
/// Implicit integrators minimise an energy, and `valence` pressure is not the force of one.
inline bool can_integrate(Integrator integrator, const SoftMaterial& material) {
  return !is_implicit(integrator) || material.pressure == PressureWeighting::uniform;
}

inline double time_step(const Settings& settings) { return 1.0 / settings.steps_per_second; }
inline double time(const World& world) {
  return static_cast<double>(world.steps) / world.settings.steps_per_second;
}

}  // namespace pneuma::sim
