#include "sim/step/swept/impacts/lone_pairs.h"

#include <algorithm>
#include <cmath>

#include "sim/step/swept/impacts/hits_apart.h"

namespace pneuma::sim {
namespace {

/// rad: what tilts by no more lies on its floor with a face.
constexpr double allowed_tilt = 1e-3;

/// Whether the other is level with a side's floor.
bool is_level(const ImpactSide& side, const ImpactSide& other, const SweptContact& contact) {
  if (!side.is_on_floor()) return false;
  const Vec3& up = side.floor().normal;
  if (std::abs(up.dot(contact.normal)) >= 1.0 - allowed_tilt) return true;
  return !other.is_ground() &&
         other.height(other.start(), up) <= side.floor_height() + contact.wanted;
}

}  // namespace

bool LonePairs::stands(int body) const {
  if (body == swept_ground) return true;
  return m_.bodies.is_box(body) && is_fixed(world_, body) && !moves(world_, body);
}

bool LonePairs::is_wall(int body) const {
  return stands(body) || (m_.bodies.is_box(body) && is_kinematic(world_, body));
}

/// A box that something stops on its way.
bool LonePairs::may_hit(const SweptContact& contact) const {
  if (!(contact.approach > 0.0)) return false;
  // What something pushes along a floor comes to it by what friction takes in a step.
  if (contact.is_near &&
      (is_pulled(contact) || contact.approach <= least_approach(world_.settings)))
    return false;
  const int first = contact.first.body, second = contact.second.body;
  return moves_freely(first) ? moves_freely(second) || is_wall(second)
                             : is_wall(first) && moves_freely(second);
}

bool LonePairs::is_pulled(const SweptContact& contact) const {
  if (moves_freely(contact.first.body) && moves_freely(contact.second.body)) return false;
  return std::abs(contact.normal.dot(world_.settings.gravity)) * time_step(world_.settings) >
         speed_of_rest;
}

/// The bodies that each box which moves freely has contacts with, if it is one and all may hit.
void LonePairs::find_partners() {
  m_.partners.assign(at(m_.bodies.count()), {});
  for (std::size_t i = 0; i < m_.contacts.size(); ++i) {
    const int first = m_.contacts[i].first.body, second = m_.contacts[i].second.body;
    if (moves_freely(first)) add_contact(i, second, m_.partners[at(first)]);
    if (moves_freely(second)) add_contact(i, first, m_.partners[at(second)]);
  }
}

void LonePairs::add_contact(std::size_t number, int body, Partner& partner) const {
  const SweptContact& contact = m_.contacts[number];
  if (partner.contacts == 0) partner.first_contact = number;
  ++partner.contacts;
  if (rests(contact, body)) return;
  const bool hits = may_hit(contact);
  if (hits) {
    partner.restitution = std::min(partner.restitution, motion_.material(contact).restitution);
  }
  partner.is_hit = partner.is_hit || (hits && bounces_well(world_, motion_, contact));
  if (partner.others == 0) partner.first_of_others = number;
  partner.is_only_one =
      hits && (partner.others == 0 || (partner.is_only_one && partner.body == body));
  partner.body = body;
  ++partner.others;
}

bool LonePairs::rests(const SweptContact& contact, int other) const {
  if (!contact.is_near || !is_wall(other)) return false;
  const bool turns =
      other != swept_ground && !world_.rigid[at(m_.bodies.box(other))].angular_velocity.isZero(0.0);
  return !turns && std::abs(contact.normal.dot(motion_.start_velocity(contact))) <= speed_of_rest;
}

bool LonePairs::is_on_floor(const SweptContact& contact) const {
  const auto is = [&](int body) {
    return moves_freely(body) && m_.partners[at(body)].contacts > m_.partners[at(body)].others;
  };
  return is(contact.first.body) || is(contact.second.body);
}

bool LonePairs::rests_on(int body, int other) const {
  bool rests_there = false;
  for_each_contact(body, [&](std::size_t i, int touched) {
    rests_there |= touched == other && rests(m_.contacts[i], other);
  });
  return rests_there;
}

bool LonePairs::meets_only(int body, int other) const {
  if (!moves_freely(body)) return true;
  const Partner& partner = m_.partners[at(body)];
  return partner.is_only_one && partner.body == other &&
         !m_.carried_boxes.is_carried(m_.bodies.box(body));
}

bool LonePairs::is_first_of_lone_pair(std::size_t number) const {
  const SweptContact& contact = m_.contacts[number];
  const int first = contact.first.body, second = contact.second.body;
  if (!meets_only(first, second) || !meets_only(second, first)) return false;
  if (!m_.bodies.shift(contact.first).isZero(0.0) || !m_.bodies.shift(contact.second).isZero(0.0))
    return false;
  return m_.partners[at(moves_freely(first) ? first : second)].first_of_others == number;
}

ImpactSide LonePairs::side(int body, const ImpactFloor& floor) const {
  if (body == swept_ground) return {};
  const int box = m_.bodies.box(body);
  return {world_.rigid[at(box)], start_.rigid[at(box)], moves_freely(body), world_.settings.gravity,
          floor};
}

std::optional<ImpactSide> LonePairs::side_on_floor(int body) const {
  if (body == swept_ground || !moves_freely(body)) return side(body);
  ImpactFloor floor;
  bool is_one = true;
  const RigidState& start = start_.rigid[at(m_.bodies.box(body))];
  for_each_contact(body, [&](std::size_t i, int other) {
    const SweptContact& contact = m_.contacts[i];
    if (!is_one || !rests(contact, other)) return;
    const bool is_first = contact.first.body == body;
    const Vec3 up = is_first ? contact.normal : Vec3(-contact.normal);
    const Vec3 velocity = other == swept_ground ? Vec3(Vec3::Zero())
                                                : world_.rigid[at(m_.bodies.box(other))].velocity;
    const double friction = motion_.material(contact).friction;
    if (floor.count == 0) {
      floor.normal = up;
      floor.velocity = velocity;
      floor.friction = friction;
    }
    is_one = floor.count < floor.points.size() && lies_flat(body, other, up) &&
             velocity == floor.velocity && friction == floor.friction &&
             (up - floor.normal).norm() <= allowed_tilt;
    if (!is_one) return;
    const Vec3& point = is_first ? contact.first.point : contact.second.point;
    floor.points[floor.count++] = start.orientation.conjugate() * (point - start.position);
  });
  if (!is_one) return std::nullopt;
  return side(body, floor);
}

/// A face on a face: on an edge, the normal would be that of the box.
bool LonePairs::lies_flat(int body, int floor, const Vec3& up) const {
  const auto has_face = [&](const RigidState& state) {
    const Vec3 along = state.orientation.conjugate() * up;
    return along.cwiseAbs().maxCoeff() >= 1.0 - 0.5 * allowed_tilt * allowed_tilt;
  };
  const auto start = [&](int box) { return start_.rigid[at(m_.bodies.box(box))]; };
  const RigidState of_box = start(body);
  if (!has_face(of_box) || (floor != swept_ground && !has_face(start(floor)))) return false;
  const Vec3& turning = of_box.angular_velocity;
  const double reach = 0.5 * world_.rigid[at(m_.bodies.box(body))].size.norm();
  return reach * (turning - up.dot(turning) * up).norm() <= speed_of_rest;
}

bool LonePairs::are_level(const std::array<ImpactSide, 2>& sides, const SweptContact& contact) {
  return is_level(sides[0], sides[1], contact) || is_level(sides[1], sides[0], contact);
}

}  // namespace pneuma::sim
