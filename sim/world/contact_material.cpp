#include "sim/world/contact_material.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {

ContactMaterial combine(const ContactMaterial& a, const ContactMaterial& b) {
  return {std::max(a.restitution, b.restitution), std::sqrt(a.friction * b.friction)};
}

}  // namespace pneuma::sim
