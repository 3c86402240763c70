// What impulses see of the bodies of a step, do to them and have done; how these are found:
// swept_bodies.cpp.
#include <array>

#include "sim/rigid/inertia.h"
#include "sim/rigid/rigid_motion.h"
#include "sim/soft/pins.h"
#include "sim/step/stages/stages.h"
#include "sim/step/swept/swept_search.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {
namespace {

/// Of a whole vertex: a point nearer to pinned vertices is held by them.
constexpr double least_mobility = 1e-3;

}  // namespace

ContactSide SweptBodies::contact_side(int body, const Feature& feature) const {
  if (body == swept_ground) return {};
  if (is_rigid(body)) return {SideKind::rigid, box(body), {}};
  return {SideKind::soft, body, feature};
}

std::string SweptBodies::name(const World& world, int body) const {
  if (body == swept_ground) return "the ground";
  return is_rigid(body) ? world.rigid[at(box(body))].name : world.soft[at(body)].name;
}

template <class Value>
Vec3 SweptBodies::interpolate(const SurfacePoint& point, const Value& value) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; const int v : vertices(point)) sum += point.weights[i++] * value(v);
  return sum;
}

std::span<const int> SweptBodies::vertices(const SurfacePoint& point) const {
  return surface(point.body).tree->topology().feature_vertices(point.feature);
}

Vec3 SweptBodies::start_point(const SurfacePoint& point) const {
  const VertexArray& start = surface(point.body).start;
  return interpolate(point, [&](int v) { return start[v]; });
}

SweptSide SweptBodies::side(const World& world, const SurfacePoint& point) {
  if (point.body == swept_ground || is_fixed(world, point.body)) return {};
  if (is_rigid(point.body)) return {box_changes_[at(box(point.body))], point.point};
  may_be_changed_[at(point.body)] = 1;
  const SoftBody& soft = world.soft[at(point.body)];
  if (soft.pins) return pinned_side(soft, point);
  return {changes_[at(point.body)], vertices(point), point.weights, soft.material.vertex_mass};
}

/// Pinned vertices have no part in it.
SweptSide SweptBodies::pinned_side(const SoftBody& body, const SurfacePoint& point) {
  std::array<int, 3> free{};
  FeatureWeights weights{};
  std::size_t count = 0;
  double mobility = 0.0;  // of a whole vertex
  for (std::size_t i = 0; const int v : vertices(point)) {
    const double weight = point.weights[i++];
    if (is_pinned(body, v)) continue;
    free[count] = v;
    weights[count++] = weight;
    mobility += weight * weight;
  }
  if (mobility < least_mobility) return {};
  return {changes_[at(point.body)], std::span(free).first(count), weights,
          body.material.vertex_mass};
}

Vec3 SweptBodies::displacement(const World& world, const MotionStart& start,
                               const SurfacePoint& point) const {
  if (point.body == swept_ground) return Vec3::Zero();
  if (is_rigid(point.body)) {
    const std::size_t i = at(box(point.body));
    const Vec3 arm = point.point - start.rigid[i].position;
    return world.rigid[i].position + turns_[i] * arm - point.point;
  }
  const MovingSurface& moving = surface(point.body);
  return interpolate(point, [&](int v) -> Vec3 { return moving.end[v] - moving.start[v]; });
}

Vec3 SweptBodies::point_before(const World& world, const MotionStart& start, int body,
                               const Vec3& at_end) const {
  const RigidBox& now = world.rigid[at(box(body))];
  const RigidState& before = start.rigid[at(box(body))];
  const Vec3 local = now.orientation.conjugate() * (at_end - now.position);
  return before.position + before.orientation * local;
}

Vec3 SweptBodies::driven_velocity(const World& world, const SurfacePoint& point) const {
  const MovedObstacle& moved = *moved_[at(point.body)];
  const SoftBody& body = world.soft[at(point.body)];
  return interpolate(point, [&](int v) { return moved.velocity(body, v); });
}

Vec3 SweptBodies::start_velocity(const World& world, const MotionStart& start,
                                 const SurfacePoint& point) const {
  if (point.body == swept_ground) return Vec3::Zero();
  if (is_rigid(point.body)) {
    const RigidState& before = start.rigid[at(box(point.body))];
    return before.velocity + before.angular_velocity.cross(point.point - before.position);
  }
  if (is_driven(point.body)) return driven_velocity(world, point);
  const VertexArray& velocities = start.soft[at(point.body)].velocities;
  return interpolate(point, [&](int v) { return velocities[v]; });
}

Vec3 SweptBodies::end_velocity(const World& world, const SurfacePoint& point) const {
  if (point.body == swept_ground) return Vec3::Zero();
  if (is_rigid(point.body)) {
    const RigidBox& now = world.rigid[at(box(point.body))];
    return now.velocity + now.angular_velocity.cross(point.point - now.position);
  }
  if (is_driven(point.body)) return driven_velocity(world, point);
  const VertexArray& velocities = world.soft[at(point.body)].velocities;
  return interpolate(point, [&](int v) { return velocities[v]; });
}

void SweptBodies::take_as_shifts(double part) {
  shifts_ = box_changes_;
  for (BoxChange& shift : shifts_) {
    shift.velocity *= part;
    shift.angular_velocity *= part;
  }
  for (BoxChange& change : box_changes_) change.velocity = change.angular_velocity = Vec4d{};
}

Vec3 SweptBodies::shift(const SurfacePoint& point) const {
  if (shifts_.empty() || point.body == swept_ground || !is_rigid(point.body)) return Vec3::Zero();
  const BoxChange& of_box = shifts_[at(box(point.body))];
  const Vec3 arm = point.point - to_vec3(of_box.centre);
  return to_vec3(of_box.velocity) + to_vec3(of_box.angular_velocity).cross(arm);
}

double SweptBodies::work_of_shifts(const World& world) const {
  double work = 0.0;
  for (std::size_t i = 0; i < shifts_.size(); ++i) {
    work -= world.rigid[i].mass * world.settings.gravity.dot(to_vec3(shifts_[i].velocity));
  }
  return work;
}

Vec3 SweptBodies::angular_momentum_of_shift(const World& world, int box) const {
  const RigidBox& shifted = world.rigid[at(box)];
  const BoxChange& shift = shifts_[at(box)];
  RigidState before = state_of(shifted);
  before.orientation = turned(before.orientation, -to_vec3(shift.angular_velocity));
  return shifted.mass * to_vec3(shift.velocity).cross(shifted.velocity) + spin(shifted) -
         spin(shifted, before);
}

void SweptBodies::shift_boxes(World& world) const {
  for (std::size_t i = 0; i < shifts_.size(); ++i) {
    RigidBox& box = world.rigid[i];
    box.position += to_vec3(shifts_[i].velocity);
    box.orientation = turned(box.orientation, to_vec3(shifts_[i].angular_velocity));
  }
}

bool SweptBodies::let_fall(World& world, const MotionStart& start, const CarriedBoxes& carried,
                           const Vec3& way_of_carried, std::span<const std::uint8_t> is_borne) {
  bool any = false;
  for (std::size_t i = 0; i < falls_.size(); ++i) {
    const int box = static_cast<int>(i);
    falls_[i].setZero();
    if (carried.is_carried(box)) {
      falls_[i] = way_of_carried;
    } else if (is_borne[i] == 0 && !is_fixed(world, soft_count_ + box)) {
      falls_[i] = missing_fall(world.rigid[i], start.rigid[i], time_step(world.settings));
    }
    any = any || !falls_[i].isZero(0.0);
  }
  if (any) add_falls(world);
  return any;
}

void SweptBodies::add_falls(World& world) const {
  for (std::size_t i = 0; i < falls_.size(); ++i) world.rigid[i].position += falls_[i];
}

bool SweptBodies::is_to_move_again(int soft) const {
  return moved_again_[at(soft)] != 0 || !changes_[at(soft)].rows().isZero(0.0);
}

/// The state of its start, with the impulses.
const SoftState& SweptBodies::kick(const MotionStart& start, int soft) {
  moved_again_[at(soft)] = 1;
  SoftState& kicked = kicked_[at(soft)];
  kicked = start.soft[at(soft)];
  kicked.velocities.rows() += changes_[at(soft)].rows();
  return kicked;
}

/// All of them, if one has been kicked.
std::optional<Divergence> SweptBodies::move_again(World& world, const MotionStart& start,
                                                  JoinedStep& group,
                                                  IntegrateSoftMemory& integrate_soft) {
  const std::vector<int>& bodies = group.bodies();
  const auto is_to_move = [&](int i) { return !is_fixed(world, i) && is_to_move_again(i); };
  if (std::ranges::none_of(bodies, is_to_move)) return std::nullopt;
  for (const int i : bodies) {
    if (is_kinematic(world, i)) {
      kicked_[at(i)] = start.soft[at(i)];
    } else {
      kick(start, i);
    }
  }
  return integrate_group_again(world, group, kicked_, integrate_soft, 0);
}

std::optional<Divergence> SweptBodies::move_again(World& world, const MotionStart& start,
                                                  IntegrateSoftMemory& integrate_soft) {
  for (int i = 0; i < integrate_soft.alone; ++i) {
    if (is_fixed(world, i) || !is_to_move_again(i)) continue;
    if (auto failed = integrate_soft_again(world, i, kick(start, i), integrate_soft, 0)) {
      return failed;
    }
  }
  for (JoinedStep& group : integrate_soft.groups) {
    if (auto failed = move_again(world, start, group, integrate_soft)) return failed;
  }
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    if (is_asleep(world, soft_count_ + static_cast<int>(i))) continue;
    RigidState kicked = start.rigid[i];
    kicked.velocity += to_vec3(box_changes_[i].velocity);
    kicked.angular_velocity += to_vec3(box_changes_[i].angular_velocity);
    if (auto failed = integrate_rigid_again(world, static_cast<int>(i), kicked)) return failed;
  }
  add_falls(world);
  shift_boxes(world);
  return std::nullopt;
}

void SweptBodies::add_changes(World& world) const {
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    if (may_be_changed_[i] != 0) world.soft[i].velocities.rows() += changes_[i].rows();
  }
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    world.rigid[i].velocity += to_vec3(box_changes_[i].velocity);
    world.rigid[i].angular_velocity += to_vec3(box_changes_[i].angular_velocity);
  }
}

void list_pressing(const SweptMemory& memory, std::vector<Contact>& contacts) {
  const auto side = [&](const SurfacePoint& point) {
    return memory.bodies.contact_side(point.body, point.feature);
  };
  for (const MetFreely& met : memory.met_freely) {
    contacts.push_back({.first = memory.bodies.contact_side(met.first, {}),
                        .second = memory.bodies.contact_side(met.second, {}),
                        .point = met.point,
                        .normal = met.normal,
                        .impulse = met.impulse});
  }
  for (std::size_t i = 0; i < memory.contacts.size(); ++i) {
    const SweptContact& contact = memory.contacts[i];
    const Vec3 impulse = memory.given_at_start[i] + memory.impulses[i].given();
    if (impulse.isZero(0.0)) continue;
    contacts.push_back({.first = side(contact.first),
                        .second = side(contact.second),
                        .point = contact.first.point,
                        .normal = contact.normal,
                        .impulse = impulse});
  }
}

}  // namespace pneuma::sim
