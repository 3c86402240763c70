// Contacts of two soft bodies: the feature tests on the pairs of their particles (paper 5.2.1).
#pragma once

#include <cstdint>
#include <vector>

#include "sim/collision/contact.h"
#include "sim/collision/feature_contact.h"
#include "sim/collision/packed_spheres.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Memory of find_soft_soft; contents mean nothing between calls.
struct SoftSoftScratch {
  PackedSpheres second;              // about the features of the second body's particles
  std::vector<std::uint64_t> known;  // the pairs of features in contact, by their numbers
};

/// Two features of soft bodies, given by their indices in World::soft, as the response takes them:
/// they are to be moved apart (depth > 0) when a vertex is nearer to a triangle than the skin
/// thickness (5.3.1, ERRATA row 60).
Contact soft_soft_contact(int first, int second, const FeatureContact& found,
                          double skin_thickness);

/// Appends the contacts of one pair. Features are in contact when nearer than twice the skin
/// thickness. A contact that several particles find is reported once (ERRATA row 44).
void find_soft_soft(const World& world, const ParticlePair& pair, SoftSoftScratch& scratch,
                    std::vector<Contact>& contacts);

}  // namespace pneuma::sim
