// World -> meshes in full precision, for other programs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/frame/frame.h"
#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// One body at one moment. The order of vertices and triangles is the same in every frame.
struct ExportedMesh {
  std::string name;
  std::vector<sim::Vec3> vertices;  // m
  std::shared_ptr<const std::vector<sim::Triangle>> triangles;
  std::shared_ptr<const std::vector<render::Colour>> colours;  // sRGB, per vertex
};

/// Soft bodies, then boxes, in the order of the world. What stays the same over a run is made once.
class MeshExporter {
 public:
  /// `world` is the scene's world in any state.
  MeshExporter(const scenes::Scene& scene, const sim::World& world);

  std::vector<ExportedMesh> meshes(const sim::World& world) const;

 private:
  struct Surface {
    std::shared_ptr<const std::vector<sim::Triangle>> triangles;
    std::shared_ptr<const std::vector<render::Colour>> colours;
  };
  std::vector<Surface> soft_;   // as World::soft
  std::vector<Surface> rigid_;  // as World::rigid
};

}  // namespace pneuma::app
