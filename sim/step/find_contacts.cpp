#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

/// A vertex below the plane z = 0 is in contact with it (section 3.1.4).
void find_soft_ground(const World& world, std::vector<Contact>& contacts) {
  if (!world.settings.ground) return;
  for (int i = 0; i < static_cast<int>(world.soft.size()); ++i) {
    const VertexArray& positions = world.soft[at(i)].positions;
    for (int v = 0; v < positions.size(); ++v) {
      const double height = positions[v].z();
      if (height < 0.0) {
        contacts.push_back({{BodyKind::soft, i, {FeatureKind::vertex, v}},
                            {},
                            positions[v],
                            Vec3::UnitZ(),
                            -height});
      }
    }
  }
}

}  // namespace

void find_contacts(const World& world, StepWorkspace& workspace) {
  workspace.contacts.clear();
  if (workspace.plan.runs(ContactKind::soft_ground)) find_soft_ground(world, workspace.contacts);
}

}  // namespace pneuma::sim
