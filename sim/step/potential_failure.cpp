#include "sim/step/potential_failure.h"

#include <utility>

#include "sim/base/text.h"
#include "sim/inspect/closed_surface.h"

namespace pneuma::sim {
namespace {

/// Into how many parts the step was divided at last.
int parts(const PotentialMemory& memory) { return 1 << memory.max_halvings(); }

std::string features(const WayLimit& limit, const ContactPair& pair) {
  std::string text = "vertex ";
  if (limit.pair < 0) return text += std::to_string(limit.vertex);
  text = pair.is_edges ? "edges" : "a vertex and a triangle, of vertices";
  for (const int v : pair.vertices) (text += ' ') += std::to_string(v);
  return text;
}

}  // namespace

Divergence of_potential_step(const World& world, std::string body, std::string what) {
  return {Stage::integrate_soft, world.steps + 1, std::move(body), std::move(what)};
}

Divergence of_blocked_way(const World& world, const PotentialMemory& memory, const WayLimit& limit,
                          const ContactPair& pair, const std::string& why) {
  if (!limit.is_limited) {
    Divergence stiff = of_potential_step(
        world, body_name(world, 0), why + ", even in " + std::to_string(parts(memory)) + " parts");
    stiff.remedy = "a smaller simulation.potential.stiffness or an implicit integrator does";
    return stiff;
  }
  const bool on_ground = limit.pair < 0;
  const int surface = on_ground ? memory.surfaces.surface_of(limit.vertex) : pair.first;
  const std::string other = on_ground ? "the ground" : body_name(world, pair.second);
  Divergence near =
      of_potential_step(world, body_name(world, surface),
                        "it comes so near to " + other + ", at " + features(limit, pair) +
                            ", that it would pass through it, even in a " +
                            std::to_string(parts(memory)) + "th of the step");
  near.other = other;
  near.remedy = "a step of 1/" + std::to_string(2 * world.settings.steps_per_second) + " s" +
                (memory.implicit_step ? "" : " or an implicit integrator") + " may do";
  return near;
}

Divergence of_spinning_box(const World& world, const PotentialMemory& memory, int box) {
  return of_potential_step(world, world.rigid[at(box)].name,
                           "it turns by more than a radian even in a " +
                               std::to_string(parts(memory)) + "th of the step");
}

}  // namespace pneuma::sim
