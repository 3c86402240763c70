// The part of SweptBodies that knows where bodies are on their ways through the step, and which of
// them come near each other.
#include <algorithm>
#include <cmath>

#include "sim/step/swept/swept_bodies.h"
#include "sim/swept/soft_way.h"

namespace pneuma::sim {
namespace {

Bounds larger(const Bounds& bounds, double margin) {
  return {bounds.low.array() - margin, bounds.high.array() + margin};
}

}  // namespace

Bounds SweptBodies::bounds_of_way(const World& world, const MotionStart& start, int soft) const {
  const SoftWay way =
      way_of(start.soft[at(soft)], world.soft[at(soft)].positions, time_step(world.settings));
  const double margin = way.allowed_change + (1.0 + skins_around) * skin(soft);
  return {to_vec3(way.box.low - margin), to_vec3(way.box.high + margin)};
}

void SweptBodies::follow(const World& world, const MotionStart& start, int soft) {
  is_followed_[at(soft)] = 1;
  MovingSurface& surface = surfaces_[at(soft)];
  if (is_driven(soft)) {
    moved_[at(soft)]->place_all(world.soft[at(soft)], start.soft[at(soft)], surface);
  } else {
    surface.start = start.soft[at(soft)].positions;
    surface.end = world.soft[at(soft)].positions;
  }
  refit_way(world, start, soft);
}

/// In another search of the step only of what has left its allowance, so that what happens to one
/// body does not change how others are searched.
Bounds SweptBodies::refit_way(const World& world, const MotionStart& start, int body) {
  if (is_searched_[at(body)] == 0 || !is_within_allowance(body)) {
    const MovingSurface& moving = surface(body);
    refit_anew(
        body,
        is_rigid(body) || is_driven(body)
            ? allowed_of_way * max_distance(moving.start, moving.end)
            : way_of(start.soft[at(body)], moving.end, time_step(world.settings)).allowed_change);
  }
  return root_bounds(body);
}

Bounds SweptBodies::bounds_of_still(const World& world, int body) {
  if (is_fitted_[at(body)] == 0) fit_still(world, body);
  return root_bounds(body);
}

void SweptBodies::fit_still(const World& world, int body) {
  MovingSurface& surface = surfaces_[at(body)];
  if (is_rigid(body)) {
    const RigidBox& still = world.rigid[at(box(body))];
    place_corners(box(body), still.position, still.orientation.toRotationMatrix(), surface.start);
  } else {
    surface.start = world.soft[at(body)].positions;
  }
  surface.end = surface.start;
  is_fitted_[at(body)] = 1;
  refit_anew(body, 0.0);
  if (never_moves_[at(body)] != 0) obstacles_[at(body)]->keep_place(surface);
}

Bounds SweptBodies::root_bounds(int body) const {
  const WayBox& around = surface(body).nodes.front();
  return {to_vec3(around.low), to_vec3(around.high)};
}

void SweptBodies::refit_anew(int body, double allowed) {
  MovingSurface& surface = surfaces_[at(body)];
  is_searched_[at(body)] = is_refitted_[at(body)] = 1;
  allowances_[at(body)] = allowed + skin(body);
  searched_ends_[at(body)] = surface.end;
  refit(surface, skins_around * skin(body) + allowance(body));
}

void SweptBodies::find_near_bodies(const World& world, const MotionStart& start,
                                   std::vector<BodyPair>& pairs) {
  ways_.clear();
  reached_.clear();
  is_refitted_.assign(surfaces_.size(), 0);
  for (int i = 0; i < count(); ++i) {
    if (is_still_[at(i)] != 0) {
      ways_.push_back(bounds_of_still(world, i));
    } else if (is_placed_as_needed(i)) {
      ways_.push_back(larger(root_bounds(i), allowance(i) - skin(i)));
    } else {
      if (is_driven(i) && is_followed_[at(i)] == 0) follow(world, start, i);
      ways_.push_back(is_followed_[at(i)] != 0 ? refit_way(world, start, i)
                                               : bounds_of_way(world, start, i));
    }
    const double reach = is_rigid(i) ? near_of_side * shortest_sides_[at(box(i))] : 0.0;
    reached_.push_back(larger(ways_.back(), reach));
  }
  sweep_and_prune_.find(reached_, pairs);
  std::erase_if(pairs, [&](const BodyPair& pair) { return !may_be_near(pair); });
  beside_still_boxes_.clear();
  for (const BodyPair& pair : pairs) {
    if (is_rigid(pair.first) || !is_box(pair.second) || !stands_still(world, pair.second)) continue;
    beside_still_boxes_.push_back(pair);
  }
  for (const BodyPair& pair : pairs) {
    for (const int body : {pair.first, pair.second}) {
      if (is_followed_[at(body)] != 0 || is_still_[at(body)] != 0 || is_in_own_axes(body)) continue;
      follow(world, start, body);
    }
  }
}

std::span<const BodyPair> SweptBodies::still_boxes_near(int soft) const {
  const auto begin = std::ranges::lower_bound(beside_still_boxes_, soft, {}, &BodyPair::first);
  const auto end = std::ranges::upper_bound(beside_still_boxes_, soft, {}, &BodyPair::first);
  return {begin, end};
}

/// Boxes are looked at as boxes, over a distance of their own.
bool SweptBodies::may_be_near(const BodyPair& bodies) const {
  const auto& [first, second] = bodies;
  Bounds way = ways_[at(first)];
  if (is_rigid(first)) {
    const auto shortest = [&](int body) { return shortest_sides_[at(box(body))]; };
    const double reach = 2.0 * near_of_side * std::min(shortest(first), shortest(second));
    way.low.array() -= reach;
    way.high.array() += reach;
  }
  return overlap(way, ways_[at(second)]);
}

bool SweptBodies::is_within_allowance(int body) const {
  if (is_still_[at(body)] != 0) return true;
  return max_distance(surface(body).end, searched_ends_[at(body)]) <= allowance(body);
}

bool SweptBodies::search_is_valid() const {
  for (int i = 0; i < count(); ++i) {
    if (is_followed_[at(i)] == 0) continue;
    if (!is_within_allowance(i)) return false;
  }
  return true;
}

Vec3 SweptBodies::within_allowance(int body, int vertex, const Vec3& end, const Vec3& place) const {
  const Vec3 searched = searched_ends_[at(body)][vertex];
  const double allowed = allowance(body) * allowance(body);
  if ((place - searched).squaredNorm() <= allowed) return place;
  const Vec3 off = end - searched, way = place - end;
  const double along = off.dot(way), left = std::max(0.0, allowed - off.squaredNorm());
  const double squared = way.squaredNorm();
  return end + (std::sqrt(along * along + squared * left) - along) / squared * way;
}

}  // namespace pneuma::sim
