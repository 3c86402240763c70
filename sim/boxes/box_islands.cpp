#include "sim/boxes/box_islands.h"

#include <algorithm>
#include <numeric>

#include "sim/boxes/move_box_island.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Of the shortest side, around a box's way: contacts may push it aside, besides half its way.
constexpr double around_of_side = 0.05;
constexpr double around_of_way = 0.5;
/// Of the thinnest member of an island: in an impact of what goes further in a step, contacts as
/// springs give way by more than a picture may show.
constexpr double longest_way_of_side = 0.02;
/// Of the lightest member's mass: under heavier ones contacts as springs would give way.
constexpr double heaviest_of_lightest = 8.0;
/// What bounces better keeps its energy better in swept contacts.
constexpr double most_restitution = 0.3;
/// Of shortest sides, the height of a tower that leans under its weight since its contacts give
/// way; it has fewer members than so many a level.
constexpr double most_levels = 22.0;
constexpr double slender = 3.0;

Vec3 extent(const Eigen::Quaterniond& orientation, const Vec3& size) {
  return orientation.toRotationMatrix().cwiseAbs() * (0.5 * size);
}

}  // namespace

BoxIslands::BoxIslands(const World& world) : mover_(std::make_unique<BoxIslandMover>(world)) {
  const std::size_t bodies = world.soft.size() + world.rigid.size();
  is_excluded_.resize(bodies);
  is_on_ground_.resize(bodies);
  ways_.resize(bodies);
  way_lengths_.resize(bodies);
  spheres_.resize(bodies);
  parents_.resize(bodies);
  traits_.resize(bodies);
}

BoxIslands::BoxIslands(BoxIslands&&) noexcept = default;
BoxIslands::~BoxIslands() = default;

const BoxIslandsMoved& BoxIslands::moved() const { return mover_->moved(); }

void BoxIslands::begin_step() { std::ranges::fill(is_excluded_, std::uint8_t{0}); }

void BoxIslands::move(World& world, const MotionStart& start, SweptBodies& bodies) {
  touched_asleep_.clear();
  find_ways(world, start, bodies);
  if (!touched_asleep_.empty()) return;
  find_islands(world);
  find_traits(world, bodies);
  list_islands(world, bodies);
  mover_->begin(world);
  for (int i = 0; i < bodies.count(); ++i) {
    const Traits& traits = traits_[at(i)];
    if (root(i) != i || traits.is_swept || !traits.touches) continue;
    const auto part = [](const auto& all, const std::vector<int>& begin, int of) {
      return std::span(all).subspan(at(begin[at(of)]), at(begin[at(of) + 1] - begin[at(of)]));
    };
    const BoxIsland island{part(members_, member_begin_, i), part(island_pairs_, pair_begin_, i),
                           traits.longest_way, traits.thinnest};
    traits_[at(i)].is_swept = !mover_->move(world, start, bodies, island);
  }
  for (int i = 0; i < bodies.count(); ++i) {
    bodies.set_apart(i, !is_fixed(world, i) && !traits_[at(root(i))].is_swept);
  }
}

void BoxIslands::find_ways(const World& world, const MotionStart& start, SweptBodies& bodies) {
  for (int i = 0; i < bodies.count(); ++i) {
    if (bodies.is_rigid(i)) {
      find_way(world, start, bodies, i);
    } else {
      ways_[at(i)] = bodies.bounds_of_soft(world, start, i);
    }
    spheres_[at(i)] = {ways_[at(i)].centre(), 0.5 * ways_[at(i)].size().norm()};
  }
  sweep_and_prune_.find(spheres_, pairs_);
  std::erase_if(pairs_, [&](const BodyPair& pair) {
    return !overlap(ways_[at(pair.first)], ways_[at(pair.second)]);
  });
  for (const BodyPair& pair : pairs_) {
    wake_by(world, bodies, pair.first, pair.second);
    wake_by(world, bodies, pair.second, pair.first);
  }
  std::erase_if(pairs_, [&](const BodyPair& pair) {
    return is_fixed(world, pair.first) && is_fixed(world, pair.second);
  });
}

/// Whether a soft body comes near enough is seen by the search of swept contacts.
void BoxIslands::wake_by(const World& world, const SweptBodies& bodies, int body, int sleeping) {
  if (!is_asleep(world, sleeping)) return;
  const bool comes = is_kinematic(world, body) ? moves(world, body)
                                               : !is_fixed(world, body) && bodies.is_rigid(body) &&
                                                     bodies.is_rigid(sleeping);
  if (comes) touched_asleep_.push_back(sleeping);
}

void BoxIslands::find_way(const World& world, const MotionStart& start, const SweptBodies& bodies,
                          int body) {
  const RigidBox& box = world.rigid[at(bodies.box(body))];
  const RigidStart& from = start.rigid[at(bodies.box(body))];
  const Vec3 before = extent(from.orientation, box.size), after = extent(box.orientation, box.size);
  const double turns = from.angular_velocity.norm() * time_step(world.settings);
  const double length = (box.position - from.position).norm() + turns * 0.5 * box.size.norm();
  const Vec3 around = Vec3::Constant(around_of_side * box.size.minCoeff() + around_of_way * length);
  ways_[at(body)] = {(from.position - before).cwiseMin(box.position - after) - around,
                     (from.position + before).cwiseMax(box.position + after) + around};
  way_lengths_[at(body)] = length;
  is_on_ground_[at(body)] = world.settings.ground && ways_[at(body)].low.z() < 0.0 ? 1 : 0;
}

int BoxIslands::root(int body) {
  while (parents_[at(body)] != body) {
    parents_[at(body)] = parents_[at(parents_[at(body)])];
    body = parents_[at(body)];
  }
  return body;
}

/// Nothing travels through what no impulse moves.
void BoxIslands::find_islands(const World& world) {
  std::iota(parents_.begin(), parents_.end(), 0);
  for (const BodyPair& pair : pairs_) {
    if (is_fixed(world, pair.first) || is_fixed(world, pair.second)) continue;
    const int one = root(pair.first), other = root(pair.second);
    parents_[at(std::max(one, other))] = std::min(one, other);
  }
}

void BoxIslands::find_traits(const World& world, const SweptBodies& bodies) {
  std::ranges::fill(traits_, Traits{});
  for (int i = 0; i < bodies.count(); ++i) {
    if (!is_fixed(world, i)) include(traits_[at(root(i))], world, bodies, i);
  }
  for (const BodyPair& pair : pairs_) {
    const auto meet = [&](int body, int other) {
      if (is_fixed(world, body)) return;
      Traits& traits = traits_[at(root(body))];
      traits.touches = true;
      if (!bodies.is_rigid(other)) traits.is_swept = true;
      if (!bodies.is_rigid(other) || !is_fixed(world, other)) return;
      const RigidBox& box = world.rigid[at(bodies.box(other))];
      traits.restitution = std::max(traits.restitution, box.surface.restitution);
      traits.thinnest = std::min(traits.thinnest, box.size.minCoeff());
      traits.longest_way = std::max(traits.longest_way, way_lengths_[at(other)]);
    };
    meet(pair.first, pair.second);
    meet(pair.second, pair.first);
  }
  for (Traits& traits : traits_) traits.is_swept = traits.is_swept || !is_for_substeps(traits);
}

bool BoxIslands::is_for_substeps(const Traits& traits) {
  if (traits.members == 0) return true;
  const double levels = (traits.highest - traits.lowest) / traits.thinnest;
  const bool is_tower = levels > most_levels && traits.members < slender * levels;
  return !is_tower && traits.restitution <= most_restitution &&
         traits.longest_way <= longest_way_of_side * traits.thinnest &&
         traits.heaviest <= heaviest_of_lightest * traits.lightest;
}

void BoxIslands::include(Traits& traits, const World& world, const SweptBodies& bodies,
                         int body) const {
  if (!bodies.is_rigid(body) || is_excluded_[at(body)] != 0) {
    traits.is_swept = true;
    return;
  }
  const RigidBox& box = world.rigid[at(bodies.box(body))];
  const double height = -world.settings.gravity.normalized().dot(box.position);
  const bool is_first = traits.members++ == 0;
  traits.lowest = is_first ? height : std::min(traits.lowest, height);
  traits.highest = is_first ? height : std::max(traits.highest, height);
  traits.lightest = is_first ? box.mass : std::min(traits.lightest, box.mass);
  traits.thinnest = is_first ? box.size.minCoeff() : std::min(traits.thinnest, box.size.minCoeff());
  traits.heaviest = std::max(traits.heaviest, box.mass);
  traits.longest_way = std::max(traits.longest_way, way_lengths_[at(body)]);
  traits.restitution = std::max(traits.restitution, box.surface.restitution);
  if (is_on_ground_[at(body)] == 0) return;
  traits.touches = true;
  traits.restitution = std::max(traits.restitution, world.settings.ground->restitution);
}

void BoxIslands::list_islands(const World& world, const SweptBodies& bodies) {
  const std::size_t count = at(bodies.count());
  member_begin_.assign(count + 1, 0);
  pair_begin_.assign(count + 1, 0);
  const auto island = [&](int body) {
    return is_fixed(world, body) || traits_[at(root(body))].is_swept ? -1 : root(body);
  };
  const auto for_each_member = [&](const auto& visit) {
    for (int i = 0; i < bodies.count(); ++i) {
      if (const int of = island(i); of >= 0) visit(of, i);
    }
  };
  const auto for_each_pair = [&](const auto& visit) {
    for (const bool with_fixed : {false, true}) {
      for (const BodyPair& pair : pairs_) {
        const bool is_first_fixed = is_fixed(world, pair.first);
        if ((is_first_fixed || is_fixed(world, pair.second)) != with_fixed) continue;
        const int of = is_first_fixed ? island(pair.second) : island(pair.first);
        if (of >= 0) visit(of, pair);
      }
    }
    for_each_member([&](int of, int body) {
      if (is_on_ground_[at(body)] != 0) visit(of, BodyPair{body, swept_ground});
    });
  };
  for_each_member([&](int of, int) { ++member_begin_[at(of) + 1]; });
  for_each_pair([&](int of, const BodyPair&) { ++pair_begin_[at(of) + 1]; });
  std::partial_sum(member_begin_.begin(), member_begin_.end(), member_begin_.begin());
  std::partial_sum(pair_begin_.begin(), pair_begin_.end(), pair_begin_.begin());
  members_.resize(at(member_begin_.back()));
  island_pairs_.resize(at(pair_begin_.back()));
  filled_.assign(member_begin_.begin(), member_begin_.end());
  for_each_member([&](int of, int body) { members_[at(filled_[at(of)]++)] = body; });
  filled_.assign(pair_begin_.begin(), pair_begin_.end());
  for_each_pair([&](int of, const BodyPair& pair) { island_pairs_[at(filled_[at(of)]++)] = pair; });
}

}  // namespace pneuma::sim
