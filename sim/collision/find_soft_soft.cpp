#include "sim/collision/find_soft_soft.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pneuma::sim {
namespace {

struct Ball {
  Row centre;
  double radius;
};

Ball feature_ball(const SurfaceView& surface, int feature_id) {
  const Row centre = feature_centre(surface, feature_id);
  const RowReader positions(surface.positions);
  double squared = 0.0;
  for (const int v : surface.topology.feature_corners(feature_id).vertices) {
    const Row offset = positions[v] - centre;
    squared = std::max(squared, dot(offset, offset));
  }
  return {centre, std::sqrt(squared)};
}

void make_balls(const SurfaceView& surface, const std::vector<int>& features,
                SoftSoftScratch::Balls& balls) {
  for (auto* values : {&balls.x, &balls.y, &balls.z, &balls.radius}) {
    values->resize(features.size() + 3);
    std::fill(values->end() - 3, values->end(), std::numeric_limits<double>::quiet_NaN());
  }
  for (std::size_t i = 0; i < features.size(); ++i) {
    const auto [centre, radius] = feature_ball(surface, features[i]);
    balls.x[i] = centre[0];
    balls.y[i] = centre[1];
    balls.z[i] = centre[2];
    balls.radius[i] = radius;
  }
}

/// Calls visit(i) for all balls within reach (m) of one, which it compares with four at a time.
template <class Visit>
void for_each_within(const Ball& ball, double reach, const SoftSoftScratch::Balls& balls,
                     const Visit& visit) {
  for (std::size_t i = 0; i + 3 < balls.x.size(); i += 4) {
    const Row x = load_row(&balls.x[i]) - ball.centre[0];
    const Row y = load_row(&balls.y[i]) - ball.centre[1];
    const Row z = load_row(&balls.z[i]) - ball.centre[2];
    const Row far = load_row(&balls.radius[i]) + (ball.radius + reach);
    const auto within = x * x + (y * y + z * z) < far * far;
    if ((within[0] | within[1] | within[2] | within[3]) == 0) continue;
    for (int lane = 0; lane < 4; ++lane) {
      if (within[lane] != 0) visit(i + at(lane));
    }
  }
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

std::uint64_t number_of(const SurfaceView& first, const SurfaceView& second,
                        const FeatureContact& found) {
  return static_cast<std::uint64_t>(first.topology.feature_id(found.first)) << 32 |
         static_cast<std::uint32_t>(second.topology.feature_id(found.second));
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
  make_balls(second, pair.second_features, scratch.second);

  std::vector<std::uint64_t>& known = scratch.known;
  known.clear();
  for (const int first_feature : pair.first_features) {
    const Ball ball = feature_ball(first, first_feature);
    for_each_within(ball, 2.0 * skin, scratch.second, [&](std::size_t i) {
      auto found =
          find_touching_parts(first, first.topology.feature(first_feature), second,
                              second.topology.feature(pair.second_features[i]), 2.0 * skin);
      if (!found) return;
      const std::uint64_t number = number_of(first, second, *found);
      if (std::find(known.begin(), known.end(), number) != known.end()) return;
      known.push_back(number);
      found->normal = contact_normal(first, second, *found);
      contacts.push_back(soft_soft_contact(pair.first, pair.second, *found, skin));
    });
  }
}

}  // namespace pneuma::sim
