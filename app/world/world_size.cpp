#include "app/world/world_size.h"

#include <algorithm>
#include <set>

namespace pneuma::app {
namespace {

std::int64_t bytes(const sim::VertexArray& array) {
  return static_cast<std::int64_t>(sizeof(double)) * array.rows().size();
}

}  // namespace

WorldSize world_size(const sim::World& world) {
  WorldSize size;
  std::set<const sim::SoftMesh*> meshes;
  for (const sim::SoftBody& body : world.soft) {
    meshes.insert(body.mesh.get());
    const sim::MeshTopology& topology = body.mesh->topology;
    size.vertices += topology.vertex_count();
    size.springs += topology.edge_count();
    size.triangles += topology.triangle_count();
    size.state_bytes += bytes(body.positions) + bytes(body.velocities);
  }
  size.obstacles = std::ranges::count_if(
      world.soft, [](const sim::SoftBody& body) { return sim::is_kinematic(body); });
  size.soft_bodies = static_cast<std::int64_t>(world.soft.size()) - size.obstacles;
  size.rigid_boxes = static_cast<std::int64_t>(world.rigid.size());
  size.meshes = static_cast<std::int64_t>(meshes.size());
  constexpr std::int64_t box_state = 3 + 4 + 3 + 3;  // position, orientation, both velocities
  size.state_bytes += static_cast<std::int64_t>(sizeof(double)) * box_state * size.rigid_boxes;
  return size;
}

}  // namespace pneuma::app
