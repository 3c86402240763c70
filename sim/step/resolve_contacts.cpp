#include "sim/response/impulse.h"
#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

/// A vertex is put back onto the ground (3.1.4). One that friction holds is also put where it would
/// be had it slowed down evenly over the step; left where the step's forces carried it, it would
/// creep down the gentlest slope.
void resolve_soft_ground(World& world, const Contact& contact, const SoftState& start) {
  SoftBody& body = world.soft[at(contact.first.body)];
  const int v = contact.first.feature.index;
  const Vec3 start_velocity = start.velocities[v];
  const Impulse impulse = apply_contact_impulse(world, contact, -start_velocity.z());
  Vec3 position = body.positions[v];
  if (impulse.sticks) {
    position = start.positions[v] + 0.5 * time_step(world.settings) * start_velocity;
  }
  position.z() = 0.0;
  body.positions[v] = position;
}

}  // namespace

void resolve_contacts(World& world, StepWorkspace& workspace) {
  for (const Contact& contact : workspace.contacts) {
    resolve_soft_ground(world, contact, workspace.soft_start[at(contact.first.body)]);
  }
}

}  // namespace pneuma::sim
