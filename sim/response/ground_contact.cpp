#include "sim/response/ground_contact.h"

#include <algorithm>
#include <optional>

#include "sim/collision/find_body_contacts.h"
#include "sim/inspect/inspect.h"
#include "sim/response/keep_volume.h"
#include "sim/response/vertex_on_ground.h"
#include "sim/response/vibration.h"
#include "sim/soft/pressure_force.h"

namespace pneuma::sim {

void put_onto_ground(World& world, const SoftState& start, const Contact& contact, bool sticks) {
  VertexArray& positions = world.soft[at(contact.first.body)].positions;
  const int v = contact.first.feature.index;
  Vec3 position = positions[v];
  // Implicit integrators apply friction to what is on or below the ground themselves.
  if (sticks && !is_implicit(world.settings.integrator)) {
    position = start.positions[v] + 0.5 * time_step(world.settings) * Vec3(start.velocities[v]);
  }
  position.z() = 0.0;
  positions[v] = position;
}

namespace {

ContactMaterial with_ground(const World& world, int soft) {
  return combine(world.soft[at(soft)].material.surface, *world.settings.ground);
}

/// Gives the vertex of a contact the velocity, m/s.
void set_velocity(World& world, const Vec3& velocity, Contact& contact) {
  SoftBody& body = world.soft[at(contact.first.body)];
  const int v = contact.first.feature.index;
  contact.impulse = body.material.vertex_mass * (velocity - body.velocities[v]);
  body.velocities[v] = velocity;
}

void rest_on_ground(World& world, const SoftState& start, Contact& contact,
                    const ContactMaterial& pair) {
  const int v = contact.first.feature.index;
  Vec3 velocity = world.soft[at(contact.first.body)].velocities[v];
  const bool sticks = meet_ground(-start.velocities[v].z(), pair, velocity);
  set_velocity(world, velocity, contact);
  put_onto_ground(world, start, contact, sticks);
}

}  // namespace

void resolve_alone(World& world, const SoftState& start, Contact& contact) {
  rest_on_ground(world, start, contact, with_ground(world, contact.first.body));
}

void keep_volume(SoftBody& body, const VertexArray& before) {
  if (gas_strength(body.material) == 0.0) return;
  keep_volume(body.mesh->topology, before, body.positions);
}

namespace {

struct Bounce {
  Vec3 velocity;  // m/s, at the end of the step
  double height;  // m, likewise
};

/// Of a vertex below the ground, if it bounces there.
std::optional<Bounce> bounce_of(const World& world, const SoftState& start, const Contact& contact,
                                const ContactMaterial& pair) {
  const SoftBody& body = world.soft[at(contact.first.body)];
  const int v = contact.first.feature.index;
  const double fastest = -std::min(start.velocities[v].z(), body.velocities[v].z());
  if (pair.restitution * fastest < min_bounce_speed) return std::nullopt;
  Vec3 velocity = body.velocities[v];
  const GroundImpact impact = ground_impact(start.positions[v].z(), start.velocities[v].z(),
                                            body.positions[v].z(), velocity.z());
  const auto height = bounce(impact, pair, time_step(world.settings), velocity);
  if (!height) return std::nullopt;
  return Bounce{velocity, *height};
}

void bounce_or_rest(World& world, int soft, const SoftState& start, std::span<Contact> contacts) {
  SoftBody& body = world.soft[at(soft)];
  const ContactMaterial pair = with_ground(world, soft);
  const bool any = std::ranges::any_of(contacts, [&](const Contact& contact) {
    return bounce_of(world, start, contact, pair).has_value();
  });
  if (!any) {
    for (Contact& contact : contacts) rest_on_ground(world, start, contact, pair);
    return;
  }
  const Vec3& gravity = world.settings.gravity;
  const double before = energy(body, gravity).total();
  for (Contact& contact : contacts) {
    const auto bounced = bounce_of(world, start, contact, pair);
    if (!bounced) {
      rest_on_ground(world, start, contact, pair);
      continue;
    }
    set_velocity(world, bounced->velocity, contact);
    body.positions[contact.first.feature.index].z() = bounced->height;
  }
  take_from_vibration(body, energy(body, gravity).total() - before);
}

}  // namespace

void resolve_on_ground(World& world, int soft, const SoftState& start, std::span<Contact> contacts,
                       VertexArray& before) {
  if (contacts.empty()) return;
  if (!is_implicit(world.settings.integrator)) return bounce_or_rest(world, soft, start, contacts);
  SoftBody& body = world.soft[at(soft)];
  before = body.positions;
  const ContactMaterial pair = with_ground(world, soft);
  for (Contact& contact : contacts) rest_on_ground(world, start, contact, pair);
  keep_volume(body, before);
}

void meet_ground_alone(World& world, int soft, const SoftState& start,
                       std::vector<Contact>& contacts, VertexArray& before) {
  const std::size_t first = contacts.size();
  find_soft_ground(world, soft, contacts);
  resolve_on_ground(world, soft, start, std::span(contacts).subspan(first), before);
}

}  // namespace pneuma::sim
