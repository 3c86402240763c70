#include "sim/collision/find_soft_soft.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

using Ball = SoftSoftScratch::Ball;

Ball feature_ball(const SurfaceView& surface, int feature_id) {
  const Row centre = feature_centre(surface, feature_id);
  const RowReader positions(surface.positions);
  double squared = 0.0;
  for (const int v : surface.topology.feature_corners(feature_id).vertices) {
    const Row offset = positions[v] - centre;
    squared = std::max(squared, dot(offset, offset));
  }
  return {to_vec3(centre), std::sqrt(squared)};
}

void make_balls(const SurfaceView& surface, const std::vector<int>& features,
                std::vector<Ball>& balls) {
  balls.clear();
  for (const int feature : features) balls.push_back(feature_ball(surface, feature));
}

bool within(const Ball& a, const Ball& b, double reach) {
  const double far = a.radius + b.radius + reach;
  return (a.centre - b.centre).squaredNorm() < far * far;
}

/// How much a vertex and a triangle are to be moved apart so that the skin thickness lies between
/// them; the distance counts along the normal, so that a vertex behind the triangle is brought
/// back.
double separation_depth(const FeatureContact& contact, double skin_thickness) {
  const bool vertex_triangle = contact.first.kind != contact.second.kind &&
                               contact.first.kind != FeatureKind::edge &&
                               contact.second.kind != FeatureKind::edge;
  if (!vertex_triangle) return 0.0;
  const double height = (contact.first_point - contact.second_point).dot(contact.normal);
  return skin_thickness - height;
}

bool same_features(const Contact& contact, const FeatureContact& found) {
  return contact.first.feature == found.first && contact.second.feature == found.second;
}

}  // namespace

Contact soft_soft_contact(int first, int second, const FeatureContact& found,
                          double skin_thickness) {
  return {{BodyKind::soft, first, found.first},
          {BodyKind::soft, second, found.second},
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
  make_balls(first, pair.first_features, scratch.first);
  make_balls(second, pair.second_features, scratch.second);

  const auto start = static_cast<std::ptrdiff_t>(contacts.size());
  for (std::size_t i = 0; i < scratch.first.size(); ++i) {
    for (std::size_t j = 0; j < scratch.second.size(); ++j) {
      if (!within(scratch.first[i], scratch.second[j], 2.0 * skin)) continue;
      auto found =
          find_touching_parts(first, first.topology.feature(pair.first_features[i]), second,
                              second.topology.feature(pair.second_features[j]), 2.0 * skin);
      if (!found) continue;
      const auto known =
          std::find_if(contacts.begin() + start, contacts.end(),
                       [&](const Contact& contact) { return same_features(contact, *found); });
      if (known != contacts.end()) continue;
      found->normal = contact_normal(first, second, *found);
      contacts.push_back(soft_soft_contact(pair.first, pair.second, *found, skin));
    }
  }
}

}  // namespace pneuma::sim
