// One contact between two bodies, or a body and the ground, as detection hands it to the response.
#pragma once

#include <cstdint>

#include "sim/mesh/topology.h"

namespace pneuma::sim {

enum class BodyKind : std::uint8_t { soft, rigid, ground };

/// One side of a contact: a feature of a soft body, a point of a rigid box, or the ground.
struct ContactSide {
  BodyKind kind = BodyKind::ground;
  int body = 0;     // index into World::soft or World::rigid
  Feature feature;  // of a soft body
};

struct Contact {
  ContactSide first;  // never the ground
  ContactSide second;
  Vec3 point = Vec3::Zero();   // where the bodies touch, m
  Vec3 normal = Vec3::Zero();  // unit; the impulse on `first` is along +normal (section 5.3.1)
  double depth = 0.0;  // m the sides must move apart along the normal; at or below 0 for none
  double gap = 0.0;    // m by which they may still approach: of boxes, which rest by touching
};

}  // namespace pneuma::sim
