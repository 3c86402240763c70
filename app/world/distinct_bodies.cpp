#include "app/world/distinct_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace pneuma::app {
namespace {

bool alike(const sim::SoftBody& a, const sim::SoftBody& b) {
  const auto numbers = [](const sim::SoftMaterial& m) {
    return std::array{m.k,           m.n,     m.temperature, m.gas_exponent, m.ambient_pressure,
                      m.vertex_mass, m.rho_g, m.k_max,       m.bending,      m.bending_damping};
  };
  return a.mesh == b.mesh && a.supply == b.supply && numbers(a.material) == numbers(b.material) &&
         a.material.damping == b.material.damping &&
         a.material.pressure_weighting == b.material.pressure_weighting;
}

}  // namespace

std::vector<DistinctBody> distinct_bodies(const sim::World& world) {
  std::vector<DistinctBody> known;
  for (const sim::SoftBody& body : world.soft) {
    if (sim::is_kinematic(body)) continue;  // nothing of it moves by itself
    const auto same = std::find_if(known.begin(), known.end(), [&](const DistinctBody& other) {
      return alike(*other.first, body);
    });
    if (same == known.end()) {
      known.push_back({&body});
    } else {
      ++same->count;
    }
  }
  return known;
}

std::string body_and_alike(const std::string& name, int count) {
  return fmt::format("body '{}'{}", name,
                     count > 1 ? fmt::format(" and {} like it", count - 1) : "");
}

}  // namespace pneuma::app
