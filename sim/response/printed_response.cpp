#include "sim/response/printed_response.h"

#include <algorithm>

#include "sim/response/contact_islands.h"

namespace pneuma::sim {
namespace {

bool is_between_boxes(const Contact& contact) {
  return contact.first.kind == SideKind::rigid && contact.second.kind == SideKind::rigid;
}

void apply_impulse(World& world, std::span<const BoxMass> masses, Contact& contact) {
  const SolverSide first(world, masses, contact.first, contact.point);
  const SolverSide second(world, masses, contact.second, contact.point);
  const ContactMaterial pair =
      combine(surface(world, contact.first), surface(world, contact.second));
  const Vec4d normal = to_vec4d(contact.normal);
  const double inverse_mass =
      dot(normal, first.mobility() * normal) + dot(normal, second.mobility() * normal);
  const double approach = -dot(first.velocity() - second.velocity(), normal);
  double impulse = (pair.restitution + 1.0) * approach / inverse_mass;
  if (!is_between_boxes(contact)) impulse = std::max(0.0, impulse);
  first.apply(impulse * normal);
  second.apply(-impulse * normal);
  contact.impulse = impulse * contact.normal;
  if (!is_soft_ground(contact)) return;
  SoftBody& body = world.soft[at(contact.first.body)];
  const int v = contact.first.feature.index;
  const Vec3 velocity = body.velocities[v];
  const Vec3 change = printed_friction(velocity, contact.normal, pair.friction, impulse);
  body.velocities[v] = velocity + change;
  contact.impulse += body.material.vertex_mass * change;
}

/// Both sides' centre stays (ERRATA row 62).
void separate_boxes(World& world, const Contact& contact) {
  RigidBox& first = world.rigid[at(contact.first.body)];
  RigidBox& second = world.rigid[at(contact.second.body)];
  const double of_first = second.mass / (first.mass + second.mass);
  first.position += of_first * contact.depth * contact.normal;
  second.position -= (1.0 - of_first) * contact.depth * contact.normal;
}

/// The only vertex of the contact, or the first side: the whole box that a corner belongs to.
const ContactSide& moved_side(const Contact& contact) {
  const bool second_is_vertex = contact.first.kind == SideKind::soft &&
                                contact.second.kind == SideKind::soft &&
                                contact.second.feature.kind == FeatureKind::vertex;
  return second_is_vertex ? contact.second : contact.first;
}

void move_out(World& world, std::span<const Vec3> box_positions, const Contact& contact) {
  if (!(contact.depth > 0.0)) return;
  const ContactSide& side = moved_side(contact);
  const Vec3 way = &side == &contact.first ? contact.normal : Vec3(-contact.normal);
  if (side.kind == SideKind::soft) {
    world.soft[at(side.body)].positions[side.feature.index] += contact.depth * way;
    return;
  }
  Vec3& position = world.rigid[at(side.body)].position;
  const double moved = (position - box_positions[at(side.body)]).dot(way);
  position += (contact.depth - std::clamp(moved, 0.0, contact.depth)) * way;
}

}  // namespace

Vec3 printed_friction(const Vec3& velocity, const Vec3& normal, double friction, double impulse) {
  const Vec3 parallel = velocity - velocity.dot(normal) * normal;
  const double speed = parallel.norm();
  if (speed == 0.0) return Vec3::Zero();
  return -friction * std::max(impulse, 0.0) / speed * parallel;
}

void apply_printed_impulses(World& world, std::span<const BoxMass> masses,
                            std::span<Contact> contacts) {
  for (Contact& contact : contacts) apply_impulse(world, masses, contact);
}

void separate_as_printed(World& world, std::span<const Vec3> box_positions,
                         std::span<const Contact> contacts) {
  for (const Contact& contact : contacts) {
    if (is_soft_ground(contact)) {
      world.soft[at(contact.first.body)].positions[contact.first.feature.index].z() = 0.0;
    } else if (is_between_boxes(contact)) {
      separate_boxes(world, contact);
    } else {
      move_out(world, box_positions, contact);
    }
  }
}

}  // namespace pneuma::sim
