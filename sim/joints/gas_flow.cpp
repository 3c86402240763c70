#include "sim/joints/gas_flow.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/joints/orifice.h"
#include "sim/mesh/measure.h"
#include "sim/rigid/given_motion.h"
#include "sim/soft/gas_law.h"

namespace pneuma::sim {
namespace {

/// Of the time in which a difference of pressure would be gone at its present rate: the length of
/// one step of Runge-Kutta.
constexpr double part_of_time = 0.05;

/// Of the higher pressure that there was: a difference below this is none.
constexpr double even = 1e-12;

double value(const std::vector<KeyFrame>& keys, bool smooth, double time) {
  return value_at(keys, smooth, time).x();
}

}  // namespace

bool has_gas_flow(const World& world) {
  return !world.valves.empty() || std::ranges::any_of(world.soft, [](const SoftBody& body) {
    return body.supply != nullptr;
  });
}

bool has_gas_flow(const World& world, int soft_body) {
  return world.soft[at(soft_body)].supply != nullptr ||
         std::ranges::any_of(world.valves, [&](const Valve& valve) {
           return valve.first == soft_body || valve.second == soft_body;
         });
}

GasFlow::GasFlow(const World& world) {
  std::vector<std::size_t> part_of(world.soft.size());
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    if (!has_gas_flow(world, static_cast<int>(i))) continue;
    const SoftBody& body = world.soft[i];
    part_of[i] = parts_.size();
    Part part;
    part.body = static_cast<int>(i);
    part.outside_temperature = body.material.temperature;
    if (body.supply) {
      part.leak = effective_area(body.supply->leak);
      part.outside_temperature = body.supply->outside_temperature;
    }
    part.has_openings = part.leak > 0.0;
    parts_.push_back(part);
  }
  for (const Valve& valve : world.valves) {
    const std::size_t first = part_of[at(valve.first)], second = part_of[at(valve.second)];
    valves_.push_back({first, second, effective_area(valve.orifice)});
    parts_[first].has_openings = parts_[second].has_openings = true;
  }
  gas_.resize(parts_.size());
  stage_.resize(parts_.size());
  for (std::vector<Gas>& slopes : slopes_) slopes.resize(parts_.size());
}

void GasFlow::begin_step(World& world) {
  for (Part& part : parts_) {
    const SoftMaterial& material = world.soft[at(part.body)].material;
    part.start_n = material.n;
    part.start_temperature = material.temperature;
  }
  const double step = time_step(world.settings);
  measure(world);
  const double before = energy(world);
  flow(world, 0.5 * step);
  const double now = static_cast<double>(world.steps);
  take_keys(world, now * step, (now + 0.5) * step);
  work_ = energy(world) - before;
}

void GasFlow::end_step(World& world) {
  const double step = time_step(world.settings);
  measure(world);
  const double before = energy(world);
  const double now = static_cast<double>(world.steps);
  take_keys(world, (now - 0.5) * step, now * step);
  flow(world, 0.5 * step);
  work_ += energy(world) - before;
}

void GasFlow::take_back(World& world) const {
  for (const Part& part : parts_) {
    world.soft[at(part.body)].material.n = part.start_n;
    world.soft[at(part.body)].material.temperature = part.start_temperature;
  }
}

void GasFlow::measure(const World& world) {
  for (Part& part : parts_) {
    const SoftBody& body = world.soft[at(part.body)];
    part.volume = volume(body.mesh->topology, body.positions);
    part.exponent = body.material.gas_exponent;
    part.outside = body.material.ambient_pressure;
    part.is_open = part.has_openings && part.volume > 0.0;
    part.per_strength = 1.0 / part.volume;
    if (part.exponent != 1.0) {
      part.per_strength *= std::pow(body.material.start_volume / part.volume, part.exponent - 1.0);
    }
  }
}

/// J, of the gas of all parts at their volumes. An obstacle's is not reported.
double GasFlow::energy(const World& world) const {
  double sum = 0.0;
  for (const Part& part : parts_) {
    const SoftBody& body = world.soft[at(part.body)];
    if (!is_kinematic(body) && part.volume > 0.0) sum += gas_energy(body.material, part.volume);
  }
  return sum;
}

/// A body that nothing else changes has the n of its keys, others get or lose as much as that
/// changes; what is not there cannot be taken.
void GasFlow::take_keys(World& world, double from, double to) {
  for (const Part& part : parts_) {
    SoftMaterial& material = world.soft[at(part.body)].material;
    const GasSupply* supply = world.soft[at(part.body)].supply.get();
    if (!supply) continue;
    if (!supply->temperature.empty()) {
      material.temperature = value(supply->temperature, supply->smooth, to);
    }
    if (supply->n.empty()) continue;
    const double target = value(supply->n, supply->smooth, to);
    const double change = target - value(supply->n, supply->smooth, from);
    const double before = material.n;
    material.n = part.has_openings ? std::max(0.0, before + change) : target;
    if (part.exponent == 1.0 || !(part.volume > 0.0) || !(material.n > 0.0)) continue;
    const double strength = before * gas_constant * material.temperature;
    const double per_volume = part.per_strength * part.volume;
    const double pumped = part.exponent * gas_constant * part.outside_temperature / per_volume;
    const double added = material.n - before;
    const double after = added > 0.0 ? strength + pumped * added
                                     : strength * std::pow(material.n / before, part.exponent);
    material.temperature = after / (material.n * gas_constant);
  }
}

double GasFlow::pressure(const Part& part, const Gas& gas) const {
  return part.per_strength * gas.strength;
}

double GasFlow::temperature(const Part& part, const Gas& gas) const {
  if (part.exponent == 1.0) return part.temperature;
  if (!(gas.n > 0.0)) return part.outside_temperature;
  return pressure(part, gas) * part.volume / (gas.n * gas_constant);
}

/// Returns how fast the fastest difference of pressure goes, 1/s; 0: all are even.
double GasFlow::rates(const std::vector<Gas>& gas, std::vector<Gas>& change) const {
  double fastest = 0.0;
  for (Gas& of_part : change) of_part = {};
  /// d(nRT at the start volume) by dn moles of a temperature.
  const auto add = [&](std::size_t i, double moles, double their_temperature) {
    const Part& part = parts_[i];
    const bool kept = part.exponent == 1.0;
    const double of_mole = gas_constant * (kept ? part.temperature : their_temperature);
    const double per_volume = part.per_strength * part.volume;
    change[i].n += moles;
    change[i].strength += kept ? of_mole * moles : part.exponent * of_mole * moles / per_volume;
  };
  const auto meet = [&](std::size_t i, double flux, double difference) {
    const Part& part = parts_[i];
    const double slope =
        part.exponent * gas_constant * temperature(part, gas[i]) / part.volume;  // Pa per mol
    fastest = std::max(fastest, flux / difference * slope);
  };
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    if (!part.is_open || part.leak == 0.0) continue;
    const double inside = pressure(part, gas[i]);
    if (std::abs(inside - part.outside) <= even * part.reference) continue;
    const bool leaves = inside > part.outside;
    const double from = leaves ? temperature(part, gas[i]) : part.outside_temperature;
    const double moles = part.leak * orifice_flux(std::max(inside, part.outside), from,
                                                  std::min(inside, part.outside));
    add(i, leaves ? -moles : moles, from);
    meet(i, moles, std::abs(inside - part.outside));
  }
  for (const Opening& valve : valves_) {
    if (!parts_[valve.first].is_open || !parts_[valve.second].is_open) continue;
    const double one = pressure(parts_[valve.first], gas[valve.first]);
    const double other = pressure(parts_[valve.second], gas[valve.second]);
    const double reference =
        std::max(parts_[valve.first].reference, parts_[valve.second].reference);
    if (std::abs(one - other) <= even * reference) continue;
    const std::size_t from = one > other ? valve.first : valve.second;
    const std::size_t to = one > other ? valve.second : valve.first;
    const double their = temperature(parts_[from], gas[from]);
    const double moles =
        valve.area * orifice_flux(std::max(one, other), their, std::min(one, other));
    add(from, -moles, their);
    add(to, moles, their);
    meet(from, moles, std::abs(one - other));
    meet(to, moles, std::abs(one - other));
  }
  return fastest;
}

/// From the first slopes.
void GasFlow::take_runge_kutta_step(double step) {
  static constexpr std::array fractions = {0.5, 0.5, 1.0};
  for (std::size_t s = 0; s < fractions.size(); ++s) {
    const double part = fractions[s] * step;
    for (std::size_t i = 0; i < gas_.size(); ++i) {
      stage_[i] = {gas_[i].n + part * slopes_[s][i].n,
                   gas_[i].strength + part * slopes_[s][i].strength};
    }
    rates(stage_, slopes_[s + 1]);
  }
  const auto sum = [&](std::size_t i, double Gas::*of) {
    const double middle = slopes_[1][i].*of + slopes_[2][i].*of;
    return step / 6.0 * (slopes_[0][i].*of + 2.0 * middle + slopes_[3][i].*of);
  };
  for (std::size_t i = 0; i < gas_.size(); ++i) {
    gas_[i].n += sum(i, &Gas::n);
    gas_[i].strength += sum(i, &Gas::strength);
  }
}

/// What has leaked into vacuum until next to nothing of it was left. Without gas a body may lie
/// flat.
void GasFlow::empty() {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    if (!part.is_open || part.leak == 0.0 || part.outside > 0.0) continue;
    if (pressure(part, gas_[i]) <= even * part.reference) gas_[i] = {};
  }
}

/// Opposite ends of a valve get the same numbers with opposite signs, so that what they have
/// together changes by rounding only.
void GasFlow::flow(World& world, double seconds) {
  bool any = false;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    const SoftMaterial& material = world.soft[at(part.body)].material;
    part.temperature = material.temperature;
    gas_[i] = {material.n, gas_strength(material)};
    any = any || part.is_open;
    if (part.is_open) part.reference = std::max(pressure(part, gas_[i]), part.outside);
  }
  if (!any) return;
  for (double left = seconds; left > 0.0;) {
    const double fastest = rates(gas_, slopes_[0]);
    if (fastest == 0.0) break;
    const double step = std::min(left, part_of_time / fastest);
    take_runge_kutta_step(step);
    left -= step;
  }
  empty();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (!parts_[i].is_open) continue;
    SoftMaterial& material = world.soft[at(parts_[i].body)].material;
    material.n = gas_[i].n;
    if (parts_[i].exponent == 1.0 || !(material.n > 0.0)) continue;
    material.temperature = gas_[i].strength / (material.n * gas_constant);
  }
}

}  // namespace pneuma::sim
