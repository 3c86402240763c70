#include "app/world/gas_advice.h"

#include <fmt/format.h>

#include <cmath>

#include "app/world/distinct_bodies.h"
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

std::optional<double> max_held(const sim::SoftBody& body) {
  try {
    return sim::max_held_gas(body.mesh->topology, body.positions, body.material);
  } catch (const sim::EquilibriumError&) {
    return std::nullopt;
  }
}

GasAdvice gas_advice(const sim::SoftBody& body, int max_vertices) {
  GasAdvice advice;
  advice.body = body.name;
  advice.vertices = body.mesh->topology.vertex_count();
  advice.volume = sim::volume(body.mesh->topology, body.positions);
  advice.left_out = advice.vertices > max_vertices && sim::gas_strength(body.material) > 0.0;
  if (!advice.left_out) advice.settled = settled_volume(body);
  advice.k = body.material.k;
  if (advice.blown_up()) advice.max_held = max_held(body);
  return advice;
}

}  // namespace

bool GasAdvice::blown_up() const { return settled && *settled > most_growth * volume; }

std::vector<GasAdvice> gas_advices(const sim::World& world, int max_vertices) {
  std::vector<GasAdvice> advices;
  for (const DistinctBody& body : distinct_bodies(world)) {
    advices.push_back(gas_advice(*body.first, max_vertices));
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
  if (!advice.max_held) return grows + "; less gas (n) keeps it smaller";
  return fmt::format(
      "{}; to keep its size use rest = \"equilibrium\" with n of at most {} mol, which is what "
      "springs of k = {:g} N/m hold",
      grows, base::text_below(*advice.max_held), advice.k);
}

}  // namespace pneuma::app
