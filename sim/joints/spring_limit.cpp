#include "sim/joints/spring_limit.h"

#include <algorithm>

#include "sim/soft/damping.h"
#include "sim/soft/pins.h"

namespace pneuma::sim {
namespace {

/// 1/kg: what a force on all vertices of an end moves their middle by. Pinned ones do not move.
double mobility(const World& world, const SpringEnd& end) {
  const SoftBody& body = world.soft[at(end.body)];
  if (is_kinematic(body)) return 0.0;
  const auto count = static_cast<double>(end.vertices.size());
  const auto free = std::ranges::count_if(end.vertices, [&](int v) { return !is_pinned(body, v); });
  return static_cast<double>(free) / (count * count * body.material.vertex_mass);
}

Oscillation alone(const World& world, const BodySpring& spring) {
  const double mobile = mobility(world, spring.first) + mobility(world, spring.second);
  return {spring.k * mobile, spring.damping * mobile};
}

bool share_a_vertex(const SpringEnd& one, const SpringEnd& other) {
  return one.body == other.body &&
         std::ranges::find_first_of(one.vertices, other.vertices) != one.vertices.end();
}

bool pull_on_common_vertices(const BodySpring& one, const BodySpring& other) {
  for (const SpringEnd* end : {&one.first, &one.second}) {
    if (share_a_vertex(*end, other.first) || share_a_vertex(*end, other.second)) return true;
  }
  return false;
}

}  // namespace

Oscillation spring_oscillation(const World& world, int soft_body) {
  Oscillation fastest;
  for (const BodySpring& spring : world.springs) {
    if (spring.first.body != soft_body && spring.second.body != soft_body) continue;
    Oscillation together;
    for (const BodySpring& other : world.springs) {
      if (!pull_on_common_vertices(spring, other)) continue;
      const Oscillation of_other = alone(world, other);
      together.squared_frequency += of_other.squared_frequency;
      together.decay += of_other.decay;
    }
    fastest.squared_frequency = std::max(fastest.squared_frequency, together.squared_frequency);
    fastest.decay = std::max(fastest.decay, together.decay);
  }
  return fastest;
}

StabilityLimit joined_stability_limit(Integrator integrator, const World& world, int soft_body) {
  const SoftBody& body = world.soft[at(soft_body)];
  const StabilityLimit own = settled_stability_limit(integrator, body);
  const Oscillation springs = spring_oscillation(world, soft_body);
  if (springs.squared_frequency == 0.0 && springs.decay == 0.0) return own;
  if (is_implicit(integrator)) {
    return {stability_limit(Integrator::symplectic_euler, springs), springs};
  }
  const Oscillation both{own.motion.squared_frequency + springs.squared_frequency,
                         own.motion.decay + springs.decay};
  return {stability_limit(integrator, both, 1.0 - literal_fraction(body.material)), both};
}

}  // namespace pneuma::sim
