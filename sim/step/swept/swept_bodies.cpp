#include "sim/step/swept/swept_bodies.h"

#include <algorithm>
#include <map>
#include <utility>

#include "sim/mesh/primitives.h"
#include "sim/soft/pins.h"
#include "sim/step/stages/stages.h"
#include "sim/swept/soft_way.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// At most, of the mean edge of a soft body, and of the shortest side of a box: too thin to be
/// seen, and thick enough that directions between surfaces keep their digits.
constexpr double skin_of_edge = 0.01;
constexpr double skin_of_side = 0.0025;

/// Of these: thinner than this the solver's tolerance and the room to move in are rounding.
constexpr double thinnest = 0.1;

double thin_skin(double wanted, double most) { return std::clamp(wanted, thinnest * most, most); }

}  // namespace

SweptBodies::SweptBodies(const World& world) : soft_count_(static_cast<int>(world.soft.size())) {
  const double skin = world.settings.skin_thickness;
  std::map<const SoftMesh*, std::shared_ptr<const SurfaceTree>> trees;
  for (const SoftBody& body : world.soft) {
    std::shared_ptr<const SurfaceTree>& tree = trees[body.mesh.get()];
    if (!tree) {
      tree = std::make_shared<SurfaceTree>(body.mesh->topology, body.mesh->rest_positions, false);
    }
    surfaces_.emplace_back().tree = tree;
    skins_.push_back(thin_skin(skin, skin_of_edge * tree->mean_edge()));
    changes_.emplace_back(is_kinematic(body) ? 0 : body.positions.size());
    never_moves_.push_back(is_still(body) ? 1 : 0);
    know_obstacle(body);
    has_pins_ = has_pins_ || body.pins;
  }
  for (const RigidBox& box : world.rigid) {
    const TriangleMesh mesh = make_box(box.size, 1);
    corners_.push_back(to_vertex_array(mesh.vertices));
    boxes_.push_back(std::make_unique<const MeshTopology>(static_cast<int>(mesh.vertices.size()),
                                                          mesh.triangles));
    auto tree = std::make_shared<SurfaceTree>(*boxes_.back(), corners_.back(), true);
    MovingSurface& surface = surfaces_.emplace_back();
    surface.tree = std::move(tree);
    surface.start = surface.end = VertexArray(corners_.back().size());
    shortest_sides_.push_back(box.size.minCoeff());
    skins_.push_back(thin_skin(skin, skin_of_side * shortest_sides_.back()));
  }
  number_nodes(world);
  never_moves_.resize(surfaces_.size());
  obstacles_.resize(surfaces_.size());
  moved_.resize(surfaces_.size());
  seen_.resize(surfaces_.size());
  if (std::ranges::any_of(moved_, [](const auto& moved) { return moved != nullptr; })) {
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      seen_[i].tree = surfaces_[i].tree;
      seen_[i].start = seen_[i].end = VertexArray(seen_[i].tree->topology().vertex_count());
    }
  }
  is_still_.resize(surfaces_.size());
  pushes_.resize(surfaces_.size());
  is_fitted_.resize(surfaces_.size());
  is_followed_.assign(surfaces_.size(), 1);
  is_lone_.assign(surfaces_.size(), 0);
  may_be_changed_.resize(world.soft.size());
  kicked_.resize(world.soft.size());
  falls_.assign(world.rigid.size(), Vec3::Zero());
  start_axes_.assign(world.rigid.size(), Mat3::Identity());
  end_axes_ = turns_ = start_axes_;
  allowances_.resize(surfaces_.size());
  searched_ends_.resize(surfaces_.size());
}

/// The last of the soft bodies so far.
void SweptBodies::know_obstacle(const SoftBody& body) {
  MovingSurface& surface = surfaces_.back();
  obstacles_.emplace_back();
  moved_.emplace_back();
  if (!keeps_shape(body)) return;
  if (is_still(body)) {
    obstacles_.back() = std::make_unique<ObstacleShape>(body.mesh->topology, body.pins->start);
    return;
  }
  const double margin = (1.0 + skins_around) * skins_.back();
  moved_.back() = std::make_unique<MovedObstacle>(surface.tree, body, margin);
  surface.start = surface.end = VertexArray(body.positions.size());
  surface.nodes.resize(1);
}

void SweptBodies::number_nodes(const World& world) {
  first_nodes_.push_back(0);
  for (const SoftBody& body : world.soft) {
    first_nodes_.push_back(first_nodes_.back() + body.positions.size());
  }
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    first_nodes_.push_back(first_nodes_.back() + 1);
  }
}

void SweptBodies::place_corners(int box, const Vec3& position, const Mat3& axes,
                                VertexArray& corners) const {
  const VertexArray& own = corners_[at(box)];
  for (int v = 0; v < own.size(); ++v) corners[v] = position + axes * Vec3(own[v]);
}

void SweptBodies::set_start(const World& world, const MotionStart& start,
                            std::span<const double> parts_done, double fraction) {
  moved_again_.assign(world.soft.size(), 0);
  is_searched_.assign(surfaces_.size(), 0);
  std::fill_n(is_followed_.begin(), soft_count_, std::uint8_t{0});
  std::fill_n(is_lone_.begin(), soft_count_, std::uint8_t{1});
  find_what_is_still(world);
  for (int i = 0; i < soft_count_; ++i) {
    if (!moved_[at(i)]) continue;
    moved_[at(i)]->begin_part(world.soft[at(i)], start.soft[at(i)], parts_done, fraction);
    if (is_in_own_axes(i)) see_in_own_axes(i);
  }
  for (int i = 0; i < static_cast<int>(world.rigid.size()); ++i) {
    const RigidState& box = start.rigid[at(i)];
    const Mat3& axes = start_axes_[at(i)] = end_axes_[at(i)] = box.orientation.toRotationMatrix();
    turns_[at(i)].setIdentity();
    if (is_still_[at(soft_count_ + i)] != 0) continue;
    place_corners(i, box.position, axes, surfaces_[at(soft_count_ + i)].start);
  }
}

/// A box also once it has stopped.
bool SweptBodies::is_moved(const World& world, int body) const {
  if (!is_rigid(body)) return never_moves_[at(body)] == 0;
  return is_kinematic(world, body) &&
         (pushes(body) || moves(world, body) || world.rigid[at(box(body))].motion);
}

void SweptBodies::find_what_is_still(const World& world) {
  for (int i = 0; i < count(); ++i) {
    const bool is_still = never_moves_[at(i)] != 0 || is_asleep(world, i);
    is_still_[at(i)] = is_still ? 1 : 0;
    pushes_[at(i)] = is_moved(world, i) ? 1 : 0;
    if (!is_still) is_fitted_[at(i)] = 0;
  }
}

/// Until something needs all of its vertices.
void SweptBodies::see_in_own_axes(int obstacle) {
  const MovedObstacle& moved = *moved_[at(obstacle)];
  const Bounds way = moved.bounds_of_way();
  surfaces_[at(obstacle)].nodes.front() = {to_vec4d(way.low), to_vec4d(way.high)};
  allowances_[at(obstacle)] = allowed_of_way * moved.longest_way() + skin(obstacle);
}

void SweptBodies::leave_in_place(std::span<const std::uint8_t> is_driven) {
  for (std::size_t i = 0; i < is_driven.size(); ++i) {
    if (is_driven[i] != 0) moved_[i]->leave_in_place();
  }
}

void SweptBodies::end_step(SoftBody& body, int number, bool may_leave_behind) {
  moved_[at(number)]->end_step(body, may_leave_behind);
}

void SweptBodies::place_left_behind(World& world) {
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    if (moved_[i]) moved_[i]->catch_up(world.soft[i], world.settings, world.steps);
  }
}

void SweptBodies::begin_step(const World& world) {
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    if (moved_[i]) moved_[i]->begin_step(world.soft[i], world.settings, world.steps);
  }
}

bool SweptBodies::moves(const World& world, int body) const {
  return is_driven(body) ? moved_[at(body)]->moves() : sim::moves(world, body);
}

bool SweptBodies::stands_still(const World& world, int body) const {
  return body == swept_ground || (is_kinematic(world, body) && !moves(world, body));
}

bool SweptBodies::any_driven_moves() const {
  return std::ranges::any_of(
      moved_, [](const auto& moved) { return moved && moved->is_driven() && moved->moves(); });
}

BesideObstacle SweptBodies::beside_obstacle(int soft, int obstacle, double near, double least) {
  if (moved_[at(obstacle)]) {
    return moved_[at(obstacle)]->beside(surface(soft), seen_[at(soft)], near, least,
                                        allowance(soft));
  }
  return {.soft = surface(soft),
          .obstacle = surface(obstacle),
          .shape = *obstacles_[at(obstacle)],
          .near = near,
          .least = least,
          .allowance = allowance(soft)};
}

void SweptBodies::place_around(const World& world, const MotionStart& start, int obstacle,
                               const Feature& feature) {
  if (!is_placed_as_needed(obstacle)) return;
  moved_[at(obstacle)]->place_around(world.soft[at(obstacle)], start.soft[at(obstacle)], feature,
                                     surfaces_[at(obstacle)]);
}

void SweptBodies::place_all(const World& world, const MotionStart& start, int body) {
  if (is_placed_as_needed(body)) follow(world, start, body);
}

void SweptBodies::find_features(const World& world, const MotionStart& start,
                                const BodyPair& bodies, std::vector<NearFeatures>& found) {
  const auto [first, second] = bodies;
  found.clear();
  if (is_placed_as_needed(first) == is_placed_as_needed(second)) {
    place_all(world, start, first);
    place_all(world, start, second);
    find_near_features(surface(first), surface(second), found);
    return;
  }
  const bool is_first = is_placed_as_needed(first);
  const int obstacle = is_first ? first : second, other = is_first ? second : first;
  const MovingSurface& own = moved_[at(obstacle)]->own();
  MovingSurface& seen = seen_[at(other)];
  moved_[at(obstacle)]->look_at(surface(other), seen);
  find_near_features(is_first ? own : seen, is_first ? seen : own, found);
  for (const NearFeatures& features : found) {
    place_around(world, start, obstacle, is_first ? features.first : features.second);
  }
}

void SweptBodies::set_end(const World& world) {
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    if (is_followed_[i] == 0 || is_still_[i] != 0) continue;
    if (is_driven(static_cast<int>(i))) continue;
    surfaces_[i].end = world.soft[i].positions;
  }
  for (int i = 0; i < static_cast<int>(world.rigid.size()); ++i) {
    if (is_still_[at(soft_count_ + i)] == 0) set_end(world, soft_count_ + i);
  }
}

void SweptBodies::set_end(const World& world, int body) {
  const int i = box(body);
  const RigidBox& moved = world.rigid[at(i)];
  const Mat3& axes = end_axes_[at(i)] = moved.orientation.toRotationMatrix();
  turns_[at(i)] = axes * start_axes_[at(i)].transpose();
  place_corners(i, moved.position, axes, surfaces_[at(body)].end);
}

void SweptBodies::begin_at_start(const World& world, const MotionStart& start) {
  begin(world, [&](std::size_t i) { return start.rigid[i]; });
}

void SweptBodies::begin_at_end(const World& world) {
  begin(world, [&](std::size_t i) { return state_of(world.rigid[i]); });
}

template <class MotionOf>
void SweptBodies::begin(const World& world, const MotionOf& motion) {
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    if (may_be_changed_[i] != 0) changes_[i].rows().setZero();
  }
  std::ranges::fill(may_be_changed_, std::uint8_t{0});
  box_changes_.clear();
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    if (is_asleep(world, soft_count_ + static_cast<int>(i))) {
      box_changes_.emplace_back();
      continue;
    }
    const RigidState box = motion(i);
    box_changes_.push_back(make_box_change(world.rigid[i], box.position, box.orientation));
  }
}

}  // namespace pneuma::sim
