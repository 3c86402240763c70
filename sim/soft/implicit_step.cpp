#include "sim/soft/implicit_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/mesh/measure.h"
#include "sim/soft/bending.h"
#include "sim/soft/pressure_force.h"
#include "sim/soft/spring_force.h"

namespace pneuma::sim {
namespace {

/// Fraction of an energy's terms: the rounding in their sum.
constexpr double energy_rounding = 1e-13;

/// Fraction of the mean rest length per step: slower is at rest.
constexpr double still_fraction = 1e-10;

/// sdirk2: the length of either part, and by how much more of what the first one changes the second
/// one starts from.
constexpr double part_of_step = 1.0 - 0.5 * std::numbers::sqrt2;
constexpr double extrapolation = 1.0 + std::numbers::sqrt2;

class ImplicitStep {
 public:
  ImplicitStep(const SoftMesh& mesh, const SoftMaterial& material, const Settings& settings,
               const SoftState& start, ImplicitScratch& scratch, const Pins* pins)
      : mesh_(mesh),
        material_(material),
        settings_(settings),
        s_(scratch),
        pins_(pins),
        step_(time_step(settings)),
        centre_(mean(start.positions)) {
    take_start(start);
    take_floor(start);
    s_.solver.set_pins(pins);
  }

  bool run(ImplicitReport& report) {
    if (gas_strength(material_) > 0.0) {
      report.volume = volume(mesh_.topology, s_.start.state.positions);
      if (!(report.volume > 0.0)) return false;
    }
    const double speed_energy = kinetic(s_.start.state.velocities);
    start_energy_ = potential(s_.start.state.positions) + speed_energy;
    if (!std::isfinite(start_energy_)) {
      report.volume = std::numeric_limits<double>::quiet_NaN();
      return false;
    }
    start_energy_ += energy_rounding * (magnitude_ + speed_energy);
    report.by_euler = settings_.integrator == Integrator::sdirk2 && !sdirk2();
    if (settings_.integrator == Integrator::implicit_euler || report.by_euler) {
      if (!implicit_euler()) {
        report.volume = 0.0;  // to rounding
        return false;
      }
    }
    report.energy_limited = limit_energy();
    if (gas_strength(material_) > 0.0) {
      report.volume = volume(mesh_.topology, s_.result.positions);
    }
    report.iterations = s_.solver.effort().iterations;
    report.factorizations = s_.solver.effort().factorizations;
    report.converged = s_.solver.effort().converged;
    return true;
  }

  void write(VertexArray& positions, VertexArray& velocities) const {
    for (int v = 0; v < positions.size(); ++v) {
      positions[v] = s_.result.positions[v] + centre_;
      velocities[v] = s_.result.velocities[v];
    }
  }

 private:
  bool does_work() const { return pins_ && pins_->are_moved; }

  void take_start(const SoftState& start) {
    for (int v = 0; v < start.positions.size(); ++v) {
      s_.start.state.positions[v] = start.positions[v] - centre_;
    }
    s_.start.state.velocities.rows() = start.velocities.rows();
    measure(mesh_, material_, s_.start.state.positions, s_.start.deformation);
  }

  void take_floor(const SoftState& start) {
    if (!settings_.ground) {
      s_.solver.set_body(material_, settings_.gravity, 0.0);
      s_.solver.set_no_ground();
      return;
    }
    s_.solver.set_body(material_, settings_.gravity,
                       combine(material_.surface, *settings_.ground).friction);
    // A vertex that is below the ground already is resolve_contacts' business.
    for (int v = 0; v < start.positions.size(); ++v) {
      s_.solver.set_floor(v, std::min(start.positions[v].z(), 0.0) - centre_.z());
    }
  }

  double kinetic(const VertexArray& velocities) const {
    return 0.5 * material_.vertex_mass * velocities.rows().squaredNorm();
  }

  /// Of springs, gas and gravity. Adds the sizes of the terms up in magnitude_.
  double potential(const VertexArray& positions) {
    const double springs = spring_energy(mesh_, positions, material_.k) +
                           bending_energy(mesh_, positions, material_.bending);
    const GasLaw law = gas_law(material_);
    const double enclosed = volume(mesh_.topology, positions);
    const double gas = gas_energy(law, enclosed);
    const double gravity =
        -material_.vertex_mass * positions.size() * settings_.gravity.dot(mean(positions));
    magnitude_ = springs + gas_energy_size(law, enclosed) + std::abs(gravity);
    return springs + gas + gravity;
  }

  /// False when the start has no volume.
  bool implicit_euler() {
    s_.pushed.assign(s_.pushed.size(), 0);
    if (!s_.solver.step(step_, s_.start, s_.start.state.positions)) return false;
    see_what_is_pushed();
    s_.result.positions.rows() = s_.solver.positions().rows();
    s_.result.velocities.rows() =
        (s_.result.positions.rows() - s_.start.state.positions.rows()) / step_;
    rebound();
    return true;
  }

  /// What hits the ground rests on it afterwards, or parts with restitution times the
  /// speed with which it came, as in resolve_contacts. Within the step the ground has only braked
  /// it so far that it has just arrived: the rest of the impulse comes with friction, too.
  void rebound() {
    if (!settings_.ground) return;
    const ContactMaterial pair = combine(material_.surface, *settings_.ground);
    for (int v = 0; v < s_.result.velocities.size(); ++v) {
      if (!s_.pushed[at(v)]) continue;
      Vec3 velocity = s_.result.velocities[v];
      const double parting = -pair.restitution * s_.start.state.velocities[v].z();
      const double before = velocity.z();
      velocity.z() = parting > min_bounce_speed ? parting : 0.0;
      const double sliding = velocity.head<2>().norm();
      if (sliding > 0.0) {
        const double braked = pair.friction * (velocity.z() - before);
        velocity.head<2>() *= std::max(0.0, 1.0 - braked / sliding);
      }
      s_.result.velocities[v] = velocity;
    }
  }

  /// False when the step must be left to implicit_euler.
  bool sdirk2() {
    const double part = part_of_step * step_;
    s_.pushed.assign(s_.pushed.size(), 0);
    if (!s_.solver.step(part, s_.start, s_.start.state.positions)) return false;
    see_what_is_pushed();
    if (hits_ground()) return false;
    s_.middle.rows() = s_.solver.positions().rows();
    extrapolate(part);
    if (!s_.solver.step(part, s_.extrapolated, s_.middle)) return false;
    see_what_is_pushed();
    if (hits_ground()) return false;
    s_.result.positions.rows() = s_.solver.positions().rows();
    s_.result.velocities.rows() =
        (s_.result.positions.rows() - s_.extrapolated.state.positions.rows()) / part;
    return does_work() || potential(s_.result.positions) <= start_energy_;
  }

  void extrapolate(double part) {
    const SoftState& start = s_.start.state;
    SoftState& ahead = s_.extrapolated.state;
    const auto change = s_.middle.rows() - start.positions.rows();
    ahead.positions.rows() = start.positions.rows() + extrapolation * change;
    ahead.velocities.rows() =
        start.velocities.rows() + extrapolation * (change / part - start.velocities.rows());
    measure(mesh_, material_, s_.middle, s_.extrapolated.deformation);
    sim::extrapolate(s_.start.deformation, extrapolation, s_.extrapolated.deformation);
  }

  /// By the ground, in the solver's last step.
  void see_what_is_pushed() {
    for (int v = 0; v < s_.middle.size(); ++v) s_.pushed[at(v)] |= s_.solver.is_pushed(v);
  }

  /// Whether the ground has pushed a vertex that was not at rest on it.
  bool hits_ground() const {
    if (!settings_.ground) return false;
    const double still = still_fraction * s_.solver.mean_rest_length() / step_;
    for (int v = 0; v < s_.middle.size(); ++v) {
      if (!s_.pushed[at(v)]) continue;
      if (s_.start.state.positions[v].z() + centre_.z() > 0.0) return true;
      if (std::abs(s_.start.state.velocities[v].z()) > still) return true;
    }
    return false;
  }

  /// Cuts the velocities to what is left of the energy: those relative to the centre's, and only if
  /// that is not enough, on the ground, its own too. Returns whether it was needed.
  bool limit_energy() {
    VertexArray& velocities = s_.result.velocities;
    const double left = std::max(0.0, start_energy_ - potential(s_.result.positions));
    if (does_work() || kinetic(velocities) <= left) return false;
    const Vec3 common = pins_ ? Vec3(Vec3::Zero()) : mean(velocities);
    const double of_common = 0.5 * material_.vertex_mass * velocities.size() * common.squaredNorm();
    const Vec3 kept = of_common <= left ? common : Vec3(Vec3::Zero());
    for (int v = 0; v < velocities.size(); ++v) velocities[v] -= kept;
    const double of_kept = of_common <= left ? of_common : 0.0;
    velocities.rows() *= std::min(1.0, std::sqrt((left - of_kept) / kinetic(velocities)));
    for (int v = 0; v < velocities.size(); ++v) velocities[v] += kept;
    return true;
  }

  const SoftMesh& mesh_;
  const SoftMaterial& material_;
  const Settings& settings_;
  ImplicitScratch& s_;
  const Pins* pins_;
  double step_;
  Vec3 centre_;
  double start_energy_ = 0.0;  // J, and its rounding on top
  double magnitude_ = 0.0;     // J
};

}  // namespace

ImplicitScratch::ImplicitScratch(const SoftMesh& mesh)
    : solver(mesh),
      start(mesh),
      extrapolated(mesh),
      middle(mesh.topology.vertex_count()),
      result{VertexArray(mesh.topology.vertex_count()), VertexArray(mesh.topology.vertex_count())},
      pushed(at(mesh.topology.vertex_count())) {}

ImplicitReport implicit_step(const SoftMesh& mesh, const SoftMaterial& material,
                             const Settings& settings, const SoftState& start,
                             VertexArray& positions, VertexArray& velocities,
                             ImplicitScratch& scratch, const Pins* pins) {
  ImplicitReport report;
  ImplicitStep step(mesh, material, settings, start, scratch, pins);
  if (step.run(report)) step.write(positions, velocities);
  return report;
}

}  // namespace pneuma::sim
