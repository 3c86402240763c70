#include "app/world/gas_advice.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "app/world/distinct_bodies.h"
#include "app/world/fill_body.h"
#include "app/world/settled_volume.h"
#include "sim/equilibrium/held_shape.h"
#include "sim/mesh/measure.h"
#include "sim/rigid/given_motion.h"
#include "sim/soft/gas_law.h"

namespace pneuma::app {
namespace {

/// Times its volume: a body that grows further has no more than its first picture in common with
/// the shape in the scene file.
constexpr double most_growth = 2.0;
/// Likewise of a body that keys fill in time, which is to grow: here to twice its length.
constexpr double most_filled_growth = 8.0;
/// Times its volume: less is called crushed.
constexpr double least_share = 0.5;
/// Times its volume: what is advised for.
constexpr double carried_share = 0.8;

/// Of the energy that stretches all springs to twice their length: a start that sets free more
/// leaves nothing of the shape. That of inflation = 2 without ambient pressure is half of this.
constexpr double most_set_free = 0.1;

/// Of the volume at the start: what is left unbalanced moves a held body by less.
constexpr double held_change = 0.1;

/// N/m, from which on springs hold the shape and no push folds it.
std::optional<double> steady_k(const sim::SoftBody& body, const sim::SoftMaterial& material) {
  if (body.mesh->topology.vertex_count() > sim::quickly_stable) return std::nullopt;
  return sim::stable_stiffness(*body.mesh, body.mesh->rest_positions, material);
}

/// mol, with which springs can hold the shape, without folding. Whether they fold is left out
/// beside an ambient pressure, where their tensions are not in proportion to the gas.
std::optional<double> max_held(const sim::SoftBody& body) {
  try {
    const double most = sim::max_held_gas(*body.mesh, body.positions, body.material);
    if (!std::isfinite(most) || body.material.ambient_pressure > 0.0) return most;
    sim::SoftMaterial filled = body.material;
    filled.n = 0.999 * most;
    return most * body.material.k / steady_k(body, filled).value_or(body.material.k);
  } catch (const sim::EquilibriumError&) {
    return std::nullopt;
  }
}

/// Whether springs are stretched or pressed in the shape that the body was given.
bool is_held(const sim::SoftBody& body) {
  constexpr double rounding = 1e-9;
  const auto& edges = body.mesh->topology.edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [a, b] = edges[e];
    const double length = (body.mesh->rest_positions[b] - body.mesh->rest_positions[a]).norm();
    if (std::abs(length - body.mesh->rest_lengths[e]) > rounding * length) return true;
  }
  return false;
}

void predict_folding(const sim::SoftBody& body, GasAdvice& advice) {
  advice.held = sim::gas_strength(body.material) > 0.0 && is_held(body);
  if (!advice.held || advice.filled_at || advice.left_out || body.pins) return;
  try {
    const auto k = steady_k(body, body.material);
    if (k && *k > body.material.k) advice.steady_k = k;
  } catch (const sim::EquilibriumError&) {
    return;  // rest lengths of its own
  }
}

bool has_valve(const sim::World& world, const sim::SoftBody& body) {
  const auto is_end = [&](int end) { return &world.soft[sim::at(end)] == &body; };
  return std::ranges::any_of(world.valves, [&](const sim::Valve& valve) {
    return is_end(valve.first) || is_end(valve.second);
  });
}

/// With the most gas that its keys give it, and when, if that is more than at the start. Where gas
/// also flows by itself, keys say what is pumped in and not what is there.
sim::SoftBody most_filled(const sim::World& world, const sim::SoftBody& body,
                          std::optional<double>& filled_at) {
  sim::SoftBody filled = body;
  if (!body.supply || body.supply->leak.area > 0.0 || has_valve(world, body)) return filled;
  const sim::GasSupply& supply = *body.supply;
  for (const auto* keys : {&supply.n, &supply.temperature}) {
    for (const sim::KeyFrame& key : *keys) {
      sim::SoftMaterial then = body.material;
      const auto value = [&](const std::vector<sim::KeyFrame>& of) {
        return sim::value_at(of, supply.smooth, key[0]).x();
      };
      if (!supply.n.empty()) then.n = value(supply.n);
      if (!supply.temperature.empty()) then.temperature = value(supply.temperature);
      if (sim::gas_strength(then) <= sim::gas_strength(filled.material)) continue;
      filled.material = then;
      filled_at = key[0];
    }
  }
  return filled;
}

/// m^2 as seen from above; of a body with folds more, as what is hidden counts too.
double ground_plan(const sim::SoftBody& body) {
  double twice = 0.0;
  for (const sim::Triangle& t : body.mesh->topology.triangles()) {
    const sim::Vec3 a(body.positions[t[0]]), b(body.positions[t[1]]), c(body.positions[t[2]]);
    twice += 0.5 * std::abs((b - a).cross(c - a).z());
  }
  return 0.5 * twice;
}

/// Weight of a body without gas over k times the length of an edge, above which it falls flat:
/// vertices of the closed meshes here snap through by less than that of springs that only stretch.
constexpr double limp_weight = 0.1;

/// Whether springs alone, without hinges and unless it hangs, have more to carry than they can.
bool is_limp(const sim::SoftBody& body, double weight) {
  const std::vector<double>& lengths = body.mesh->rest_lengths;
  if (body.material.bending > 0.0 || body.pins || lengths.empty()) return false;
  const double sum = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const double edge = sum / static_cast<double>(lengths.size());
  return weight > limp_weight * body.material.k * edge;
}

/// Whether springs carry its weight: some of its pinned vertices are as high as its middle, but for
/// rounding.
bool hangs(const sim::SoftBody& body) {
  if (!body.pins) return false;
  const double middle = sim::mean(body.positions).z() - 1e-9;
  for (int v = 0; v < body.positions.size(); ++v) {
    if (body.pins->is_pinned[sim::at(v)] != 0 && body.positions[v].z() >= middle) return true;
  }
  return false;
}

/// kg that the gas carries on an area, m^2, in nearly its volume, m^3.
double carried_mass(const sim::GasLaw& law, double volume, double area, double gravity) {
  return std::max(0.0, sim::gauge_pressure(law, carried_share * volume)) * area / gravity;
}

/// m/s^2, that presses it onto the ground.
double gravity_on(const sim::SoftBody& body, const sim::Settings& settings) {
  return settings.ground && !hangs(body) ? std::max(0.0, -settings.gravity.z()) : 0.0;
}

/// Springs are left out: they hold a shape against its gas, and hardly against a weight.
void predict_pressed(const sim::SoftBody& body, const sim::Settings& settings, GasAdvice& advice) {
  const sim::GasLaw law = sim::gas_law(body.material);
  const double gravity = gravity_on(body, settings);
  if (gravity == 0.0 && law.ambient_pressure == 0.0) return;
  const double area = ground_plan(body);
  advice.weight = advice.mass * gravity;
  const double needed = law.ambient_pressure + advice.weight / area;
  advice.carrying_pressure =
      std::max(0.0, needed * std::pow(carried_share, law.exponent) - law.ambient_pressure);
  if (law.strength == 0.0) {
    advice.limp = is_limp(body, advice.weight);
    return;
  }
  advice.ambient_pressure = law.ambient_pressure;
  advice.pressure_at_start = sim::gauge_pressure(law, advice.volume);
  advice.pressed = advice.volume * std::pow(sim::absolute_pressure(law, advice.volume) / needed,
                                            1.0 / law.exponent);
  if (gravity == 0.0) return;
  advice.light_mass = carried_mass(law, advice.volume, area, gravity);
  if (advice.max_held) {
    sim::SoftMaterial held = body.material;
    held.n = *advice.max_held;
    advice.held_mass = carried_mass(sim::gas_law(held), advice.volume, area, gravity);
  }
  // Beside an ambient pressure gas is not in proportion to what springs hold.
  if (advice.pressure_at_start > 0.0 && law.ambient_pressure == 0.0) {
    advice.strengthened = advice.carrying_pressure / advice.pressure_at_start;
  }
}

/// J, that would stretch all springs to twice their length.
double energy_of_twice_the_length(const sim::SoftBody& body) {
  double squares = 0.0;
  for (const double length : body.mesh->rest_lengths) squares += length * length;
  return 0.5 * body.material.k * squares;
}

/// Of the gas less half of what it does against springs that in the end hold its pressure.
void predict_start(const sim::SoftBody& body, GasAdvice& advice) {
  if (!advice.settled || !std::isfinite(*advice.settled) || advice.filled_at) return;
  if (*advice.settled <= advice.volume) return;
  const sim::GasLaw law = sim::gas_law(body.material);
  advice.settled_pressure = sim::gauge_pressure(law, *advice.settled);
  advice.set_free = sim::gas_energy(law, advice.volume) - sim::gas_energy(law, *advice.settled) -
                    0.5 * advice.settled_pressure * (*advice.settled - advice.volume);
  advice.shatters = advice.set_free > most_set_free * energy_of_twice_the_length(body);
}

GasAdvice gas_advice(const sim::World& world, const sim::SoftBody& at_start, int max_vertices) {
  GasAdvice advice;
  const sim::SoftBody body = most_filled(world, at_start, advice.filled_at);
  advice.body = body.name;
  advice.vertices = body.mesh->topology.vertex_count();
  advice.mass = body.material.vertex_mass * advice.vertices;
  advice.volume = sim::volume(body.mesh->topology, body.positions);
  advice.left_out = advice.vertices > max_vertices && sim::gas_strength(body.material) > 0.0;
  if (!advice.left_out) advice.settled = settled_volume(body);
  advice.k = body.material.k;
  advice.bending = body.material.bending;
  advice.n = body.material.n;
  advice.temperature = body.material.temperature;
  predict_start(body, advice);
  predict_folding(body, advice);
  const bool leaves_by_itself = advice.leaves_shape() && !advice.steady_k;
  if (advice.blown_up() || leaves_by_itself) advice.max_held = max_held(body);
  predict_pressed(body, world.settings, advice);
  advice.limp &= !has_valve(world, at_start);
  return advice;
}

}  // namespace

bool GasAdvice::crushed() const { return limp || (pressed && *pressed < least_share * volume); }

bool GasAdvice::blown_up() const {
  return settled && *settled > (filled_at ? most_filled_growth : most_growth) * volume;
}

bool GasAdvice::bursts() const { return shatters && !blown_up(); }

bool GasAdvice::leaves_shape() const {
  if (!held || filled_at || blown_up()) return false;
  return steady_k || (settled && std::abs(*settled - volume) > held_change * volume);
}

double GasAdvice::gas_over_held() const { return max_held ? std::max(1.0, n / *max_held) : 1.0; }

std::vector<GasAdvice> gas_advices(const sim::World& world, int max_vertices) {
  std::vector<GasAdvice> advices;
  for (const DistinctBody& body : distinct_bodies(world)) {
    advices.push_back(gas_advice(world, *body.first, max_vertices));
    advices.back().count = body.count;
    if (!advices.back().left_out) max_vertices -= advices.back().vertices;
  }
  return advices;
}

}  // namespace pneuma::app
