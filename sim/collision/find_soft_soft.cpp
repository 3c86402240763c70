#include "sim/collision/find_soft_soft.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

/// `margin`: m, added to the radius.
BoundingSphere bounding_sphere(const SurfaceView& surface, int feature_id, double margin) {
  const Vec4d centre = feature_centre(surface, feature_id);
  const VertexReader positions(surface.positions);
  double squared = 0.0;
  for (const int v : surface.topology.feature_corners(feature_id).vertices) {
    const Vec4d offset = positions[v] - centre;
    squared = std::max(squared, dot(offset, offset));
  }
  return {to_vec3(centre), std::sqrt(squared) + margin};
}

bool is_vertex_triangle(const FeatureContact& contact) {
  return contact.first.kind != contact.second.kind && contact.first.kind != FeatureKind::edge &&
         contact.second.kind != FeatureKind::edge;
}

/// Of a vertex over a triangle along the normal; below 0 behind it.
double height_over_triangle(const FeatureContact& contact) {
  return (contact.first_point - contact.second_point).dot(contact.normal);
}

/// How much a vertex and a triangle are to be moved apart so that the skin thickness lies between
/// them; the distance counts along the normal, so that a vertex behind the triangle is brought
/// back.
double separation_depth(const FeatureContact& contact, double skin_thickness) {
  return is_vertex_triangle(contact) ? skin_thickness - height_over_triangle(contact) : 0.0;
}

/// As printed: a vertex that intersects, that is lies behind the triangle, is moved by the skin
/// thickness (ERRATA rows 60 and 68).
double printed_depth(const FeatureContact& contact, double skin_thickness) {
  return is_vertex_triangle(contact) && height_over_triangle(contact) < 0.0 ? skin_thickness : 0.0;
}

std::uint64_t number_of(const SurfaceView& first, const SurfaceView& second,
                        const FeatureContact& found) {
  return static_cast<std::uint64_t>(first.topology.feature_id(found.first)) << 32 |
         static_cast<std::uint32_t>(second.topology.feature_id(found.second));
}

}  // namespace

Contact soft_soft_contact(int first, int second, const FeatureContact& found,
                          double skin_thickness) {
  return {{SideKind::soft, first, found.first},
          {SideKind::soft, second, found.second},
          0.5 * (found.first_point + found.second_point),
          found.normal,
          separation_depth(found, skin_thickness)};
}

void find_soft_soft(const World& world, const ParticlePair& pair, SoftSoftScratch& scratch,
                    std::vector<Contact>& contacts) {
  const SoftBody& first_body = world.soft[at(pair.first)];
  const SoftBody& second_body = world.soft[at(pair.second)];
  const SurfaceView first{first_body.mesh->topology, first_body.positions};
  const SurfaceView second{second_body.mesh->topology, second_body.positions};
  const double skin = world.settings.skin_thickness;
  scratch.second.resize(pair.second_features.size());
  for (std::size_t i = 0; i < pair.second_features.size(); ++i) {
    scratch.second.set(i, bounding_sphere(second, pair.second_features[i], skin));
  }

  std::vector<std::uint64_t>& known = scratch.known;
  known.clear();
  const bool as_printed = is_as_printed(world.settings);
  const auto find = as_printed ? find_printed_contact : find_touching_parts;
  for (const int first_feature : pair.first_features) {
    const auto test = [&](std::size_t i) {
      auto found = find(first, first.topology.feature(first_feature), second,
                        second.topology.feature(pair.second_features[i]), 2.0 * skin);
      if (!found) return;
      const std::uint64_t number = number_of(first, second, *found);
      if (std::find(known.begin(), known.end(), number) != known.end()) return;
      known.push_back(number);
      if (!as_printed) found->normal = contact_normal(first, second, *found);
      contacts.push_back(soft_soft_contact(pair.first, pair.second, *found, skin));
      if (as_printed) contacts.back().depth = printed_depth(*found, skin);
    };
    const BoundingSphere sphere = bounding_sphere(first, first_feature, skin);
    for (std::size_t i = 0; i < scratch.second.size(); i += 4) {
      scratch.second.for_overlapping_of_four(i, sphere, test);
    }
  }
}

}  // namespace pneuma::sim
