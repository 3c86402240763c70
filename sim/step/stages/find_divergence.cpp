#include "sim/step/stages/find_divergence.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/text.h"
#include "sim/inspect/state_energy.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/vec4d.h"
#include "sim/soft/damping.h"
#include "sim/soft/pressure_force.h"
#include "sim/soft/spring_force.h"
#include "sim/soft/stability_limit.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Fraction of the energy of springs at twice their length, and of nRT: less gained is rounding.
constexpr double energy_rounding = 1e-9;

/// Of the energy of a body's motion in itself, to the end of a step. The fastest motion of methods
/// of the first and second order grows faster in steps that are half a percent too long, and rk4's
/// in steps that are 2 % too long.
constexpr double min_growth = 1.2;
/// Damping slows that: every so many steps, for less growth.
constexpr double min_slow_growth = 1.03;
constexpr int slow_growth_steps = 8;
/// Of that energy and of the springs': what is gained from nothing in a step that is too long.
constexpr double min_gain = 0.02;

/// Steps of free fall: what is slower is left to later steps.
constexpr double slow_falls = 10.0;

Divergence failure(const World& world, Stage stage, const SoftBody& body, int vertex,
                   const std::string& what) {
  return {stage, world.steps + 1, body.name, what, vertex};
}

int fastest_vertex(const SoftBody& body) {
  Eigen::Index vertex = 0;
  body.velocities.rows().colwise().squaredNorm().maxCoeff(&vertex);
  return static_cast<int>(vertex);
}

std::string fastest_text(const SoftBody& body, int vertex) {
  return "; vertex " + std::to_string(vertex) + " is its fastest, at " +
         base::text(Vec3(body.velocities[vertex]).norm()) + " m/s";
}

/// Sums over all vertices, which are finite only if all their terms are, and far quicker to look
/// at.
struct MotionSums {
  double positions = 0.0;  // m, of all coordinates
  double squares = 0.0;    // (m/s)^2, of all velocities
};

/// Of a step, and of its end.
struct StepSums {
  MotionSums end;
  double squares_before = 0.0;  // (m/s)^2, of the velocities at the start
  double squared_ways = 0.0;    // m^2, of each vertex' way times its springs over their mean
  // Less those of the mean motion:
  double inner_squares = 0.0;         // (m/s)^2, of the velocities at the end
  double inner_squares_before = 0.0;  // (m/s)^2, of those at the start
  double inner_ways = 0.0;            // m^2, as above
};

MotionSums motion_sums(const SoftBody& body) {
  const VertexReader x(body.positions), v(body.velocities);
  Vec4d positions{}, squares{};
  for (int i = 0; i < body.positions.size(); ++i) {
    positions += x[i];
    squares = fma(v[i], v[i], squares);
  }
  return {sum_of_lanes(positions), sum_of_lanes(squares)};
}

StepSums step_sums(const SoftBody& body, const SoftState& start) {
  const double* const weights = body.mesh->valence_weights.data();
  const VertexReader x(body.positions), v(body.velocities);
  const VertexReader x0(start.positions), v0(start.velocities);
  Vec4d positions{}, squares{}, squares_before{}, squared_ways{};
  Vec4d velocity{}, velocity_before{}, whole_way{};
  for (int i = 0; i < body.positions.size(); ++i) {
    const Vec4d end = x[i], way = end - x0[i];
    positions += end;
    squares = fma(v[i], v[i], squares);
    squares_before = fma(v0[i], v0[i], squares_before);
    squared_ways = fma(weights[i] * way, way, squared_ways);
    velocity += v[i];
    velocity_before += v0[i];
    whole_way = fma(weights[i], way, whole_way);
  }
  const double count = body.positions.size();
  StepSums sums{{sum_of_lanes(positions), sum_of_lanes(squares)},
                sum_of_lanes(squares_before),
                sum_of_lanes(squared_ways)};
  sums.inner_squares = sums.end.squares - dot(velocity, velocity) / count;
  sums.inner_squares_before = sums.squares_before - dot(velocity_before, velocity_before) / count;
  sums.inner_ways = sums.squared_ways - dot(whole_way, whole_way) / count;
  return sums;
}

std::optional<Divergence> find_wild_vertex(const World& world, Stage stage, const SoftBody& body,
                                           const MotionSums& sums) {
  if (std::isfinite(sums.positions) && sums.squares <= max_speed * max_speed) return std::nullopt;
  for (int v = 0; v < body.positions.size(); ++v) {
    const std::string name = "vertex " + std::to_string(v);
    if (!Vec3(body.positions[v]).allFinite() || !Vec3(body.velocities[v]).allFinite()) {
      return failure(world, stage, body, v,
                     name + " has a position or velocity that is not a finite number");
    }
    const double speed = Vec3(body.velocities[v]).norm();
    if (speed > max_speed) {
      return failure(world, stage, body, v,
                     name + " moves at " + base::text(speed) + " m/s, faster than " +
                         base::text(max_speed) + " m/s");
    }
  }
  return std::nullopt;
}

std::optional<Divergence> find_lost_volume(const World& world, Stage stage, const SoftBody& body,
                                           const SoftState& start, double min_volume) {
  if (gas_strength(body.material) == 0.0) return std::nullopt;
  const MeshTopology& topology = body.mesh->topology;
  const double end = volume(topology, body.positions);
  const double smallest = min_volume < end || std::isnan(min_volume) ? min_volume : end;
  const auto report = [&](const std::string& what) {
    const int vertex = fastest_vertex(body);
    return failure(world, stage, body, vertex,
                   "its volume " + what + base::text(volume(topology, start.positions)) +
                       " m^3 before the step" + fastest_text(body, vertex));
  };
  if (!(smallest > 0.0)) {
    Divergence lost =
        report("is " + base::text(smallest) + " m^3, so that it is flat or inside out, after ");
    lost.inverted = true;
    return lost;
  }
  if (end > max_growth * min_volume) {
    return report("grew to " + base::text(end) + " m^3 by a force that it had at " +
                  base::text(min_volume) + " m^3, after ");
  }
  return std::nullopt;
}

/// J, of squared velocities that add up to `squares` ((m/s)^2).
double kinetic_energy(const SoftMaterial& material, double squares) {
  return 0.5 * material.vertex_mass * squares;
}

/// J, what gas and gravity have added to motion and springs.
double work(const World& world, const SoftBody& body, const SoftState& start) {
  const MeshTopology& topology = body.mesh->topology;
  const Vec3 way = mean(body.positions) - mean(start.positions);
  const double by_gravity =
      body.material.vertex_mass * body.positions.size() * world.settings.gravity.dot(way);
  const double by_gas = gas_energy(body.material, volume(topology, start.positions)) -
                        gas_energy(body.material, volume(topology, body.positions));
  return std::max(0.0, by_gravity) + std::max(0.0, by_gas);
}

double rounding_energy(const SoftBody& body) {
  double squares = 0.0;
  for (const double length : body.mesh->rest_lengths) squares += length * length;
  return energy_rounding * (0.5 * body.material.k * squares + gas_strength(body.material));
}

/// Of a vertex.
double mean_springs(const SoftBody& body) {
  const MeshTopology& topology = body.mesh->topology;
  return 2.0 * topology.edge_count() / topology.vertex_count();
}

/// Whether the energy of motion and springs may be more than max_gain times `before` (J), which is
/// that of the start or less. No body can have strained its springs much without having moved much.
///
/// With E the energy of motion K and springs S, E1 > 100 E0 takes K1 > 50 E0 or S1 > 50 E0. In the
/// latter case S1 > 50 S0 and sqrt S1 - sqrt S0 > 0.85 sqrt S1, while lengths change by no more
/// than their ends move: (sqrt S1 - sqrt S0)^2 <= k/2 sum (|dx_a| + |dx_b|)^2 <= k sum d |dx|^2,
/// where d is the number of springs of a vertex.
bool may_have_gained_energy(const SoftBody& body, const StepSums& sums, double before) {
  const SoftMaterial& material = body.material;
  if (kinetic_energy(material, sums.end.squares) > 0.5 * max_gain * before) return true;
  return material.k * mean_springs(body) * sums.squared_ways > 0.36 * max_gain * before;
}

/// Springs are measured only of what motion alone leaves in doubt.
std::optional<Divergence> find_gained_energy(const World& world, const SoftBody& body,
                                             const SoftState& start, const StepSums& sums) {
  const SoftMaterial& material = body.material;
  const double moving = kinetic_energy(material, sums.squares_before);
  if (!may_have_gained_energy(body, sums, moving)) return std::nullopt;
  const double before = moving + spring_energy(*body.mesh, start.positions, material.k);
  if (!may_have_gained_energy(body, sums, before)) return std::nullopt;
  const double after = kinetic_energy(material, sums.end.squares) +
                       spring_energy(*body.mesh, body.positions, material.k);
  if (after <= max_gain * before) return std::nullopt;
  const double added = work(world, body, start);
  if (after <= max_gain * (before + added) + rounding_energy(body)) return std::nullopt;
  const int vertex = fastest_vertex(body);
  return failure(world, Stage::integrate_soft, body, vertex,
                 "its energy of motion and springs jumped from " + base::text(before) + " to " +
                     base::text(after) + " J, to which gas and gravity added " + base::text(added) +
                     " J" + fastest_text(body, vertex));
}

/// J, by which the energy has grown in a step, or 0 if that is little beside the motion and springs
/// at its start. Exact motion has no energy but what it had.
double gained_from_nothing(const World& world, const SoftBody& body, const SoftState& start,
                           const StepSums& sums) {
  const SoftMaterial& material = body.material;
  const Vec3& gravity = world.settings.gravity;
  const double moving = kinetic_energy(material, sums.inner_squares),
               moved = kinetic_energy(material, sums.inner_squares_before);
  const double slow = slow_falls * time_step(world.settings) * gravity.norm();
  const double mass = material.vertex_mass * body.positions.size();
  const double growth = world.steps % slow_growth_steps == 0 ? min_slow_growth : min_growth;
  if (moving <= growth * moved || moving <= 0.5 * mass * slow * slow) return 0.0;
  const double much = min_gain * (moved + spring_energy(*body.mesh, start.positions, material.k));
  // The fastest motion strains springs by about its ways, and has hardly a velocity in some
  // methods.
  const double strained = material.k * mean_springs(body) * sums.inner_ways;
  if (moving + strained <= much) return 0.0;
  const Energy before = energy(body, start, gravity);
  const double gained = energy(body, gravity).total() - before.total();
  const double rounding =
      rounding_energy(body) + energy_rounding * (std::abs(before.gas) + std::abs(before.gravity));
  return gained > much + rounding ? gained : 0.0;
}

/// Where forces have moved the body to in the step, of size 1: mostly the motion that is fastest of
/// those that there are. Pinned vertices have no part in it.
Eigen::VectorXd forced_way(const SoftBody& body, const SoftState& start, double step) {
  const int count = body.positions.size();
  Eigen::VectorXd way(3 * count);
  for (int v = 0; v < count; ++v) {
    way.segment<3>(3 * v) = body.positions[v] - start.positions[v] - step * start.velocities[v];
  }
  return way.normalized();
}

/// Of an explicit step that pressed gas or drawn springs have made too long since it was chosen:
/// that motion grows. Not of the paper's method, whose scenes run with such steps as printed, nor
/// beside pins that are moved, whose work is not known.
std::optional<Divergence> find_outgrown_step(const World& world, const SoftBody& body,
                                             const SoftState& start, const StepSums& sums) {
  const Settings& settings = world.settings;
  if (settings.integrator == Integrator::martin) return std::nullopt;
  if (body.pins && body.pins->are_moved) return std::nullopt;
  const double gained = gained_from_nothing(world, body, start, sums);
  if (gained == 0.0) return std::nullopt;
  const double step = time_step(settings);
  const VibrationMode motions(*body.mesh, body.material, start.positions);
  Eigen::VectorXd fast = forced_way(body, start, step);
  if (!body.pins) fast = motions.faster_than(fast);
  const double limit = stability_limit(settings.integrator, motions.along(fast),
                                       1.0 - literal_fraction(body.material));
  if (step <= limit) return std::nullopt;
  const int vertex = fastest_vertex(body);
  return failure(world, Stage::integrate_soft, body, vertex,
                 "it gained " + base::text(gained) +
                     " J from nothing: its shape then bears steps of " + base::text(limit) + " s" +
                     fastest_text(body, vertex));
}

}  // namespace

std::optional<Divergence> find_divergence(const World& world, const SoftBody& body,
                                          const SoftState& start, double min_volume) {
  constexpr Stage stage = Stage::integrate_soft;
  // The implicit integrators check the energy themselves.
  const bool checks_energy = !is_implicit(world.settings.integrator);
  const StepSums sums = checks_energy ? step_sums(body, start) : StepSums{.end = motion_sums(body)};
  if (auto wild = find_wild_vertex(world, stage, body, sums.end)) return wild;
  if (auto lost = find_lost_volume(world, stage, body, start, min_volume)) return lost;
  if (!checks_energy) return std::nullopt;
  if (auto gained = find_gained_energy(world, body, start, sums)) return gained;
  return find_outgrown_step(world, body, start, sums);
}

std::optional<Divergence> find_divergence_of_joined(const World& world, const SoftBody& body,
                                                    const SoftState& start, double min_volume) {
  constexpr Stage stage = Stage::integrate_soft;
  if (auto wild = find_wild_vertex(world, stage, body, motion_sums(body))) return wild;
  return find_lost_volume(world, stage, body, start, min_volume);
}

std::optional<Divergence> find_divergence(const World& world, const SoftBody& body) {
  constexpr Stage stage = Stage::resolve_contacts;
  const MotionSums sums = motion_sums(body);
  if (auto wild = find_wild_vertex(world, stage, body, sums)) return wild;
  if (gas_strength(body.material) == 0.0) return std::nullopt;
  const double left = volume(body.mesh->topology, body.positions);
  if (left > 0.0) return std::nullopt;
  const int vertex = fastest_vertex(body);
  Divergence pressed = failure(world, stage, body, vertex,
                               "its contacts pressed it flat, to a volume of " + base::text(left) +
                                   " m^3" + fastest_text(body, vertex));
  pressed.inverted = true;
  return pressed;
}

std::optional<Divergence> find_divergence(const World& world, const RigidBox& box) {
  const double sum = box.position.sum() + box.velocity.sum() + box.angular_velocity.sum() +
                     box.orientation.coeffs().sum();
  if (std::isfinite(sum)) return std::nullopt;
  return Divergence{Stage::resolve_contacts, world.steps + 1, box.name,
                    "its contacts gave it a position or velocity that is not a finite number"};
}

std::optional<Divergence> find_first_divergence(const World& world,
                                                std::vector<std::optional<Divergence>>& outcomes,
                                                base::Workers& workers) {
  outcomes.resize(world.soft.size());
  workers.for_blocks(static_cast<int>(world.soft.size()), [&](int begin, int end, int) {
    for (int i = begin; i < end; ++i) {
      if (is_fixed(world, i)) continue;
      outcomes[at(i)] = find_divergence(world, world.soft[at(i)]);
    }
  });
  for (const std::optional<Divergence>& outcome : outcomes) {
    if (outcome) return outcome;
  }
  for (const RigidBox& box : world.rigid) {
    if (auto divergence = find_divergence(world, box)) return divergence;
  }
  return std::nullopt;
}

}  // namespace pneuma::sim
