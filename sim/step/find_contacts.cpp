#include "sim/collision/find_body_contacts.h"
#include "sim/collision/find_soft_soft.h"
#include "sim/step/stages.h"

namespace pneuma::sim {

namespace {

void find_between_soft(const World& world, StepWorkspace& workspace) {
  switch (world.settings.soft_search) {
    case SoftSearch::particles:
      for (const ParticlePair& pair : world.particles) {
        if (pair.near) find_soft_soft(world, pair, workspace.soft_soft, workspace.contacts);
      }
      break;
    case SoftSearch::exact:
      for (const auto& [first, second] : workspace.soft_pairs) {
        find_exact(world, first, second, workspace.exact, workspace.contacts);
      }
      break;
  }
}

/// The pairs of one soft body follow each other.
void find_between_soft_and_rigid(const World& world, StepWorkspace& workspace) {
  int filled_with = -1;
  for (const auto& [soft, rigid] : workspace.soft_rigid_pairs) {
    if (soft != filled_with) {
      const SoftBody& body = world.soft[at(soft)];
      workspace.columns.fill({body.mesh->topology, body.positions});
      filled_with = soft;
    }
    find_soft_rigid(world, soft, rigid, workspace.columns, workspace.contacts);
  }
}

}  // namespace

void find_contacts(const World& world, StepWorkspace& workspace) {
  const Plan& plan = workspace.plan;
  const bool ground = world.settings.ground.has_value();
  std::vector<Contact>& contacts = workspace.contacts;
  contacts.clear();
  if (plan.runs(ContactKind::soft_ground) && ground) {
    for (int i = 0; i < std::ssize(world.soft); ++i) find_soft_ground(world, i, contacts);
  }
  if (plan.runs(ContactKind::rigid_ground) && ground) {
    for (int i = 0; i < std::ssize(world.rigid); ++i) find_rigid_ground(world, i, contacts);
  }
  if (plan.runs(ContactKind::soft_soft)) {
    find_between_soft(world, workspace);
  }
  if (plan.runs(ContactKind::soft_rigid)) {
    find_between_soft_and_rigid(world, workspace);
  }
  if (plan.runs(ContactKind::rigid_rigid)) {
    for (const BodyPair& pair : workspace.rigid_pairs) {
      find_rigid_rigid(world, pair.first, pair.second, contacts);
    }
  }
}

}  // namespace pneuma::sim
