#include "sim/collision/find_body_contacts.h"
#include "sim/collision/find_soft_soft.h"
#include "sim/step/stages.h"

namespace pneuma::sim {

namespace {

/// Calls find(i, thread, contacts) for every i below `count`, in blocks over the threads, and
/// appends what was found in the order of i, whatever the number of threads.
template <class Find>
void find_all(StepWorkspace& workspace, std::size_t count, const Find& find) {
  std::vector<Contact>& contacts = workspace.contacts;
  for (std::vector<Contact>& found : workspace.found) found.clear();
  // Two references are all that std::function holds without allocating.
  const auto block = [&workspace, &find](int begin, int end, int thread) {
    auto& found = thread == 0 ? workspace.contacts : workspace.found[at(thread - 1)];
    for (int i = begin; i < end; ++i) find(i, thread, found);
  };
  workspace.workers.for_blocks(static_cast<int>(count), block);
  for (const std::vector<Contact>& found : workspace.found) {
    contacts.insert(contacts.end(), found.begin(), found.end());
  }
}

void find_between_soft(const World& world, StepWorkspace& workspace) {
  if (workspace.soft_pairs.empty()) return;
  switch (world.settings.soft_search) {
    case SoftSearch::particles:
      find_all(workspace, world.particles.size(), [&](int i, int thread, auto& contacts) {
        const ParticlePair& pair = world.particles[at(i)];
        if (pair.near) find_soft_soft(world, pair, workspace.soft_soft[at(thread)], contacts);
      });
      break;
    case SoftSearch::exact:
      find_all(workspace, workspace.soft_pairs.size(), [&](int i, int thread, auto& contacts) {
        const auto& [first, second] = workspace.soft_pairs[at(i)];
        find_exact(world, first, second, workspace.exact[at(thread)], contacts);
      });
      break;
  }
}

/// The pairs of one soft body follow each other, so that a thread seldom fills its columns anew.
void find_between_soft_and_rigid(const World& world, StepWorkspace& workspace) {
  for (SoftColumns& columns : workspace.columns) columns.body = -1;
  find_all(workspace, workspace.soft_rigid_pairs.size(), [&](int i, int thread, auto& contacts) {
    const auto& [soft, rigid] = workspace.soft_rigid_pairs[at(i)];
    const Bounds& around = workspace.soft_bounds[at(soft)];
    if (!overlap(around, workspace.boxes[at(rigid)].bounds)) return;
    SoftColumns& columns = workspace.columns[at(thread)];
    if (columns.body != soft) {
      const SoftBody& body = world.soft[at(soft)];
      columns.surface.fill({body.mesh->topology, body.positions}, around);
      columns.body = soft;
    }
    find_soft_rigid(world, workspace.boxes, soft, rigid, columns.surface, contacts);
  });
}

}  // namespace

void find_contacts(const World& world, StepWorkspace& workspace) {
  const Plan& plan = workspace.plan;
  const bool ground = world.settings.ground.has_value();
  workspace.contacts.clear();
  workspace.boxes.clear();
  for (const RigidBox& box : world.rigid) workspace.boxes.push_back(place(box));
  if (plan.runs(ContactKind::soft_ground) && ground) {
    find_all(workspace, world.soft.size(),
             [&](int i, int, auto& contacts) { find_soft_ground(world, i, contacts); });
  }
  if (plan.runs(ContactKind::rigid_ground) && ground) {
    find_all(workspace, world.rigid.size(),
             [&](int i, int, auto& contacts) { find_rigid_ground(workspace.boxes, i, contacts); });
  }
  if (plan.runs(ContactKind::soft_soft)) {
    find_between_soft(world, workspace);
  }
  if (plan.runs(ContactKind::soft_rigid)) {
    find_between_soft_and_rigid(world, workspace);
  }
  if (plan.runs(ContactKind::rigid_rigid)) {
    find_all(workspace, workspace.rigid_pairs.size(), [&](int i, int, auto& contacts) {
      const BodyPair& pair = workspace.rigid_pairs[at(i)];
      find_rigid_rigid(workspace.boxes, pair.first, pair.second, contacts);
    });
  }
}

}  // namespace pneuma::sim
