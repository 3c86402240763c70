#include "app/world/gas_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/world/distinct_bodies.h"
#include "app/world/fill_body.h"
#include "app/world/settled_volume.h"
#include "sim/base/text.h"
#include "sim/mesh/measure.h"
#include "sim/soft/equilibrium.h"
#include "sim/soft/gas_law.h"

namespace pneuma::app {
namespace {

/// Times its volume: a body that grows further has no more than its first picture in common with
/// the shape in the scene file.
constexpr double most_growth = 2.0;
/// Times its volume: less is called crushed.
constexpr double least_share = 0.5;
/// Times its volume: what is advised for.
constexpr double carried_share = 0.8;

std::optional<double> max_held(const sim::SoftBody& body) {
  try {
    return sim::max_held_gas(body.mesh->topology, body.positions, body.material);
  } catch (const sim::EquilibriumError&) {
    return std::nullopt;
  }
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

/// Springs are left out: they hold a shape against its gas, and hardly against a weight.
void predict_pressed(const sim::SoftBody& body, const sim::Settings& settings, GasAdvice& advice) {
  const sim::GasLaw law = sim::gas_law(body.material);
  const double gravity = -settings.gravity.z();
  if (!settings.ground || gravity <= 0.0 || law.strength == 0.0) return;
  const double area = ground_plan(body);
  const double weight = body.material.vertex_mass * advice.vertices * gravity;
  const double needed = law.ambient_pressure + weight / area;
  advice.pressed = advice.volume * std::pow(sim::absolute_pressure(law, advice.volume) / needed,
                                            1.0 / law.exponent);
  advice.light_vertex_mass = body.material.vertex_mass *
                             sim::gauge_pressure(law, carried_share * advice.volume) * area /
                             weight;
  advice.carrying_pressure =
      std::max(0.0, needed * std::pow(carried_share, law.exponent) - law.ambient_pressure);
  const double pressure = sim::gauge_pressure(law, advice.volume);
  // Beside an ambient pressure gas is not in proportion to what springs hold.
  if (pressure > 0.0 && law.ambient_pressure == 0.0) {
    advice.strengthened = advice.carrying_pressure / pressure;
  }
}

GasAdvice gas_advice(const sim::SoftBody& body, const sim::Settings& settings, int max_vertices) {
  GasAdvice advice;
  advice.body = body.name;
  advice.vertices = body.mesh->topology.vertex_count();
  advice.volume = sim::volume(body.mesh->topology, body.positions);
  advice.left_out = advice.vertices > max_vertices && sim::gas_strength(body.material) > 0.0;
  if (!advice.left_out) advice.settled = settled_volume(body);
  advice.k = body.material.k;
  advice.n = body.material.n;
  if (advice.blown_up()) advice.max_held = max_held(body);
  predict_pressed(body, settings, advice);
  return advice;
}

}  // namespace

bool GasAdvice::crushed() const { return pressed && *pressed < least_share * volume; }

bool GasAdvice::blown_up() const { return settled && *settled > most_growth * volume; }

std::vector<GasAdvice> gas_advices(const sim::World& world, int max_vertices) {
  std::vector<GasAdvice> advices;
  for (const DistinctBody& body : distinct_bodies(world)) {
    advices.push_back(gas_advice(*body.first, world.settings, max_vertices));
    advices.back().count = body.count;
    if (!advices.back().left_out) max_vertices -= advices.back().vertices;
  }
  return advices;
}

std::string volumes_text(const GasAdvice& advice) {
  const std::string start = base::text(advice.volume) + " m^3 at the start, ";
  if (advice.left_out) {
    return fmt::format("{}at rest not predicted: with {} vertices that takes long", start,
                       advice.vertices);
  }
  if (!advice.settled) return start + "no balance of springs and gas was found";
  if (std::isinf(*advice.settled)) return start + "growing for ever: its gas meets no springs";
  const std::string times = fmt::format("{:.3g}", *advice.settled / advice.volume);
  return fmt::format("{}{} m^3{} at rest without weight", start, base::text(*advice.settled),
                     times == "1" ? "" : fmt::format(" ({} times)", times));
}

std::string gas_warning(const GasAdvice& advice) {
  const std::string grows =
      fmt::format("{}: gas blows {} up: {}", body_and_alike(advice.body, advice.count),
                  advice.count > 1 ? "them" : "it", volumes_text(advice));
  if (advice.k == 0.0) return grows + "; springs need a k above 0 N/m, or the body n = 0";
  if (!advice.max_held) return grows + "; inflation = 1.5 alone would make it 1.5 times";
  return fmt::format(
      "{}; to keep its size use rest = \"equilibrium\" with n of at most {} mol, which is what "
      "springs of k = {:g} N/m hold",
      grows, base::text_below(*advice.max_held), advice.k);
}

std::string weight_warning(const GasAdvice& advice) {
  const std::string crushed = fmt::format(
      "{}: too heavy for its gas, which would carry its weight in {:.3g} m^3 of its {:.3g} m^3; ",
      body_and_alike(advice.body, advice.count), *advice.pressed, advice.volume);
  const std::string lighter =
      advice.light_vertex_mass > 0.0
          ? fmt::format(", or at most {} kg (vertex_mass of at most {} kg)",
                        base::text_below(advice.vertices * advice.light_vertex_mass),
                        base::text_below(advice.light_vertex_mass))
          : "";
  if (!advice.strengthened || advice.k == 0.0) {
    return fmt::format("{}give it gauge_pressure = {:.3g} Pa, and springs that hold that{}",
                       crushed, advice.carrying_pressure, lighter);
  }
  const double k = *advice.strengthened * advice.k;
  return fmt::format(
      "{}give it springs and gas {:.3g} times as strong: k = {:.3g} N/m (stiffness = {:.3g} N/m) "
      "with n = {:.4g} mol (inflation stays as it is), or with gauge_pressure = {:.3g} Pa{}",
      crushed, *advice.strengthened, k, k / k_per_stiffness, *advice.strengthened * advice.n,
      advice.carrying_pressure, lighter);
}

}  // namespace pneuma::app
