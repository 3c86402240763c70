#include "sim/step/ground_contact.h"

#include "sim/collision/find_body_contacts.h"
#include "sim/response/keep_volume.h"
#include "sim/response/vertex_on_ground.h"
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

void resolve_alone(World& world, const SoftState& start, const Contact& contact) {
  SoftBody& body = world.soft[at(contact.first.body)];
  const int v = contact.first.feature.index;
  const ContactMaterial pair = combine(body.material.surface, *world.settings.ground);
  Vec3 velocity = body.velocities[v];
  const bool sticks = meet_ground(-start.velocities[v].z(), pair, velocity);
  body.velocities[v] = velocity;
  put_onto_ground(world, start, contact, sticks);
}

void keep_volume(SoftBody& body, const VertexArray& before) {
  if (gas_strength(body.material) == 0.0) return;
  keep_volume(body.mesh->topology, before, body.positions);
}

void meet_ground_alone(World& world, int soft, const SoftState& start,
                       std::vector<Contact>& contacts, VertexArray& before) {
  SoftBody& body = world.soft[at(soft)];
  const std::size_t first = contacts.size();
  find_soft_ground(world, soft, contacts);
  if (contacts.size() == first) return;
  const bool keeps_volume = is_implicit(world.settings.integrator);
  if (keeps_volume) before = body.positions;
  for (std::size_t i = first; i < contacts.size(); ++i) resolve_alone(world, start, contacts[i]);
  if (keeps_volume) keep_volume(body, before);
}

}  // namespace pneuma::sim
