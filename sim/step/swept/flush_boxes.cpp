// The part of ContactPlaces that knows what joins the faces of boxes: others that stand beside
// them, and the ground.
#include <algorithm>

#include "sim/step/swept/contact_places.h"

namespace pneuma::sim {
namespace {

/// Of the distance wanted: what joins a box leaves no wider gap to its edge, which rises no higher
/// above it.
constexpr double widest_gap = 1.0, highest_step = 0.1;

/// Whether an edge at `of_box` does not stand out of another box beside it, as seen from `above`.
bool joins(const OrientedBox& other, const Vec3& of_box, const Vec3& above, double wanted) {
  if ((nearest_point(other, of_box) - of_box).norm() > widest_gap * wanted) return false;
  const Vec3 below = nearest_point(other, above), up = above - below;
  return up.squaredNorm() < (above - of_box).squaredNorm() &&
         up.dot(of_box - below) <= highest_step * wanted * up.norm();
}

/// The sides of a contact by what they are.
struct SoftAndBox {
  int soft = 0;
  int box = 0;
  Vec3 on_soft = Vec3::Zero();  // m
  Vec3 on_box = Vec3::Zero();
  FeaturePart part_of_box;
};

SoftAndBox sides_of(const SweptBodies& bodies, const BodyPair& pair, const ClosestPoints& closest) {
  const auto [first, second] = pair;
  if (bodies.is_rigid(second)) {
    return {first, second, closest.first_point, closest.second_point, closest.second};
  }
  return {second, first, closest.second_point, closest.first_point, closest.first};
}

}  // namespace

bool ContactPlaces::are_soft_and_still_box(const BodyPair& bodies) const {
  const auto is_soft = [&](int body) {
    return !bodies_.is_rigid(body) && !bodies_.is_obstacle(body);
  };
  const auto is_still = [&](int body) {
    return bodies_.is_box(body) && bodies_.stands_still(world_, body);
  };
  const auto [first, second] = bodies;
  return (is_soft(first) && is_still(second)) || (is_still(first) && is_soft(second));
}

/// That is nearer to it, and along the line to the edge it would be stopped by a seam.
bool ContactPlaces::is_over_flush_box(const SweptCandidate& candidate,
                                      const ClosestPoints& closest) const {
  if (!are_soft_and_still_box(candidate.bodies)) return false;
  const SoftAndBox sides = sides_of(bodies_, candidate.bodies, closest);
  if (sides.part_of_box.kind == FeatureKind::triangle) return false;
  const double wanted = motion_.distance_wanted(sides.soft, sides.box);
  const double apart = (sides.on_soft - sides.on_box).norm();
  // What lies on the ground has no height over it: an edge that is level with it must lift it.
  const double over = sides.on_soft.z() - sides.on_box.z(), least = highest_step * wanted;
  const bool is_in_ground = world_.settings.ground && sides.on_box.z() <= least;
  if (is_in_ground && over > least && sides.on_soft.z() < apart) return true;
  return std::ranges::any_of(bodies_.still_boxes_near(sides.soft), [&](const BodyPair& near) {
    return near.second != sides.box &&
           joins(start_box(near.second), sides.on_box, sides.on_soft, wanted);
  });
}

/// Whether the soft side has gone into the box: it meets the face on its way in.
bool ContactPlaces::is_in_still_box(const SweptCandidate& candidate,
                                    const ClosestPoints& closest) const {
  if (!are_soft_and_still_box(candidate.bodies)) return false;
  const SoftAndBox sides = sides_of(bodies_, candidate.bodies, closest);
  return find_box_exit(start_box(sides.box), sides.on_soft).has_value();
}

double ContactPlaces::height_over_still_boxes(const SweptCandidate& candidate) const {
  const auto [first, second] = candidate.bodies;
  const bool is_first = !bodies_.is_rigid(first);
  const int soft = is_first ? first : second;
  const auto& [of_first, of_second] = candidate.features;
  const MovingSurface& surface = bodies_.surface(soft);
  double least = candidate.start.distance;
  for (const BodyPair& near : bodies_.still_boxes_near(soft)) {
    const OrientedBox box = start_box(near.second);
    for (const int v : surface.tree->topology().feature_vertices(is_first ? of_first : of_second)) {
      const Vec3 vertex = surface.start[v];
      least = std::min(least, (vertex - nearest_point(box, vertex)).norm());
    }
  }
  return least;
}

}  // namespace pneuma::sim
