#include "app/export/exported_mesh.h"

#include "app/picture/body_colours.h"
#include "sim/mesh/primitives.h"

namespace pneuma::app {
namespace {

std::vector<sim::Vec3> rows(const sim::VertexArray& array) {
  std::vector<sim::Vec3> result;
  for (int v = 0; v < array.size(); ++v) result.emplace_back(array[v]);
  return result;
}

}  // namespace

MeshExporter::MeshExporter(const scenes::Scene& scene, const sim::World& world) {
  const auto surface = [](const std::vector<sim::Vec3>& rest, std::vector<sim::Triangle> triangles,
                          const scenes::BodyScene& body) {
    return Surface{std::make_shared<const std::vector<sim::Triangle>>(std::move(triangles)),
                   std::make_shared<const std::vector<render::Colour>>(
                       body_colours(rest, body.colours, body.colour_axis))};
  };
  // build_world puts a body's copies one after the other, in the order of the scene.
  for (const scenes::BodyScene& body : scene.bodies) {
    const auto copies = static_cast<std::size_t>(scenes::copy_count(body));
    if (scenes::is_box(body)) {
      const sim::TriangleMesh box = sim::make_box(world.rigid.at(rigid_.size()).size, 1);
      rigid_.insert(rigid_.end(), copies, surface(box.vertices, box.triangles, body));
    } else {
      const sim::SoftMesh& mesh = *world.soft.at(soft_.size()).mesh;
      soft_.insert(soft_.end(), copies,
                   surface(rows(mesh.rest_positions), mesh.topology.triangles(), body));
    }
  }
}

std::vector<ExportedMesh> MeshExporter::meshes(const sim::World& world) const {
  std::vector<ExportedMesh> result;
  for (std::size_t i = 0; i < world.soft.size(); ++i) {
    const sim::SoftBody& body = world.soft[i];
    result.push_back({body.name, rows(body.positions), soft_[i].triangles, soft_[i].colours});
  }
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    const sim::RigidBox& box = world.rigid[i];
    std::vector<sim::Vec3> corners = sim::make_box(box.size, 1).vertices;
    for (sim::Vec3& corner : corners) corner = box.position + box.orientation * corner;
    result.push_back({box.name, std::move(corners), rigid_[i].triangles, rigid_[i].colours});
  }
  return result;
}

}  // namespace pneuma::app
