#include "sim/collision/find_body_contacts.h"
#include "sim/collision/find_soft_soft.h"
#include "sim/collision/particles.h"
#include "sim/step/stages/stages.h"

namespace pneuma::sim {

namespace {

/// What the searches share: each gets what it reads, its scratch and the list to append to.
class ContactSearch {
 public:
  ContactSearch(const World& world, const NearBodies& near_bodies, std::vector<Contact>& contacts,
                FindContactsMemory& memory, base::Workers& workers)
      : world_(world),
        near_(near_bodies),
        contacts_(contacts),
        memory_(memory),
        workers_(workers) {}

  void find_soft_with_ground() {
    find_all(world_.soft.size(),
             [&](int i, int, auto& contacts) { find_soft_ground(world_, i, contacts); });
  }

  void find_rigid_with_ground() {
    const auto find =
        is_as_printed(world_.settings) ? find_printed_rigid_ground : find_rigid_ground;
    find_all(world_.rigid.size(),
             [&](int i, int, auto& contacts) { find(memory_.boxes, i, contacts); });
  }

  void find_between_soft() {
    if (near_.soft_pairs.empty()) return;
    switch (world_.settings.soft_search) {
      case SoftSearch::particles:
        find_all(world_.particles.size(), [&](int i, int thread, auto& contacts) {
          const ParticlePair& pair = world_.particles[at(i)];
          if (pair.near) find_soft_soft(world_, pair, memory_.soft_soft[at(thread)], contacts);
        });
        break;
      case SoftSearch::exact:
        find_all(near_.soft_pairs.size(), [&](int i, int thread, auto& contacts) {
          const auto& [first, second] = near_.soft_pairs[at(i)];
          find_exact(world_, first, second, memory_.exact[at(thread)], contacts);
        });
        break;
    }
  }

  /// The pairs of one soft body follow each other, so that a thread seldom fills its columns again.
  void find_between_soft_and_rigid() {
    for (FindContactsMemory::SoftColumns& columns : memory_.columns) columns.body = -1;
    find_all(near_.soft_rigid_pairs.size(), [&](int i, int thread, auto& contacts) {
      const auto& [soft, rigid] = near_.soft_rigid_pairs[at(i)];
      const Bounds& around = near_.soft_bounds[at(soft)];
      if (!overlap(around, memory_.boxes[at(rigid)].bounds)) return;
      FindContactsMemory::SoftColumns& columns = memory_.columns[at(thread)];
      if (columns.body != soft) {
        const SoftBody& body = world_.soft[at(soft)];
        columns.surface.fill({body.mesh->topology, body.positions}, around);
        columns.body = soft;
      }
      find_soft_rigid(world_, memory_.boxes, soft, rigid, columns.surface, contacts);
    });
  }

  void find_between_rigid() {
    const auto find = is_as_printed(world_.settings) ? find_printed_rigid_rigid : find_rigid_rigid;
    find_all(near_.rigid_pairs.size(), [&](int i, int, auto& contacts) {
      const auto& [first, second] = near_.rigid_pairs[at(i)];
      find(memory_.boxes, first, second, contacts);
    });
  }

 private:
  /// Calls find(i, thread, contacts) for every i below `count`, in blocks over the threads, and
  /// appends what was found in the order of i, whatever the number of threads.
  template <class Find>
  void find_all(std::size_t count, const Find& find) {
    for (std::vector<Contact>& found : memory_.found) found.clear();
    workers_.for_blocks(static_cast<int>(count), [&](int begin, int end, int thread) {
      auto& found = thread == 0 ? contacts_ : memory_.found[at(thread - 1)];
      for (int i = begin; i < end; ++i) find(i, thread, found);
    });
    for (const std::vector<Contact>& found : memory_.found) {
      contacts_.insert(contacts_.end(), found.begin(), found.end());
    }
  }

  const World& world_;
  const NearBodies& near_;
  std::vector<Contact>& contacts_;
  FindContactsMemory& memory_;
  base::Workers& workers_;
};

}  // namespace

void move_particles(World& world, const NearBodies& near_bodies, MoveParticlesMemory& memory,
                    base::Workers& workers) {
  if (near_bodies.soft_pairs.empty()) return;
  const auto block = [&](int begin, int end, int thread) {
    const double min_distance = min_particle_distance(world.settings.skin_thickness);
    for (int i = begin; i < end; ++i) {
      ParticlePair& pair = world.particles[at(i)];
      if (!pair.near) continue;
      const SoftBody& first = world.soft[at(pair.first)];
      const SoftBody& second = world.soft[at(pair.second)];
      settle_particles({first.mesh->topology, first.positions},
                       {second.mesh->topology, second.positions}, world.settings.particles,
                       min_distance, pair, memory.scratch[at(thread)]);
    }
  };
  workers.for_blocks(static_cast<int>(world.particles.size()), block);
}

void find_contacts(const World& world, const Plan& plan, const NearBodies& near_bodies,
                   std::vector<Contact>& contacts, FindContactsMemory& memory,
                   base::Workers& workers) {
  contacts.clear();
  memory.boxes.clear();
  for (const RigidBox& box : world.rigid) memory.boxes.push_back(placed_box(box));
  const bool ground = world.settings.ground.has_value();
  ContactSearch search(world, near_bodies, contacts, memory, workers);
  if (plan.runs(ContactKind::soft_ground) && ground) search.find_soft_with_ground();
  if (plan.runs(ContactKind::rigid_ground) && ground) search.find_rigid_with_ground();
  if (plan.runs(ContactKind::soft_soft)) search.find_between_soft();
  if (plan.runs(ContactKind::soft_rigid)) search.find_between_soft_and_rigid();
  if (plan.runs(ContactKind::rigid_rigid)) search.find_between_rigid();
}

}  // namespace pneuma::sim
