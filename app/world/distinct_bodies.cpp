#include "app/world/distinct_bodies.h"

#include <algorithm>
#include <array>

namespace pneuma::app {
namespace {

bool alike(const sim::SoftBody& a, const sim::SoftBody& b) {
  const auto numbers = [](const sim::SoftMaterial& m) {
    return std::array{m.k,           m.n,     m.temperature, m.gas_exponent, m.ambient_pressure,
                      m.vertex_mass, m.rho_g, m.k_max};
  };
  return a.mesh == b.mesh && numbers(a.material) == numbers(b.material) &&
         a.material.damping == b.material.damping &&
         a.material.pressure_weighting == b.material.pressure_weighting;
}

}  // namespace

std::vector<const sim::SoftBody*> distinct_bodies(const sim::World& world) {
  std::vector<const sim::SoftBody*> known;
  for (const sim::SoftBody& body : world.soft) {
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const sim::SoftBody* other) {
      return alike(*other, body);
    });
    if (!is_known) known.push_back(&body);
  }
  return known;
}

}  // namespace pneuma::app
