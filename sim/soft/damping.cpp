#include "sim/soft/damping.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

constexpr double paper_steps_per_second = 60.0;

double spring_fraction(const SoftMaterial& material) {
  return std::min(material.k / material.k_max, 1.0);
}

}  // namespace

double drag_rate(const SoftMaterial& material) {
  if (material.damping == Damping::literal) return 0.0;
  return -paper_steps_per_second * std::log1p(-material.rho_g);
}

double dashpot_constant(const SoftMaterial& material) {
  if (material.damping == Damping::literal) return 0.0;
  const double fraction = std::min(spring_fraction(material), max_spring_fraction);
  return -0.5 * material.vertex_mass * paper_steps_per_second * std::log1p(-fraction);
}

double literal_fraction(const SoftMaterial& material) {
  if (material.damping == Damping::dashpot) return 0.0;
  return material.rho_g + (1.0 - material.rho_g) * spring_fraction(material);
}

}  // namespace pneuma::sim
