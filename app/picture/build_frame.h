// World -> Frame: what the renderer is to draw of a state of the simulation.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/picture/edge_bars.h"
#include "app/picture/joint_meshes.h"
#include "app/picture/show.h"
#include "render/frame/frame.h"
#include "scenes/loader/scene.h"
#include "sim/collision/contact.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// Turns the states of one world into frames. What stays the same over a run (triangles, edges,
/// colours) is made once and shared by all frames.
class FrameBuilder {
 public:
  /// `start`: the scene's world at its start.
  FrameBuilder(const scenes::Scene& scene, const sim::World& start);

  /// `camera`: as RunCamera has it for this state. `contacts`: those of the step that led to it.
  render::Frame build(const sim::World& world, const render::Camera& camera,
                      std::span<const sim::Contact> contacts = {}, const Show& show = {}) const;

 private:
  struct Look {
    std::shared_ptr<const render::MeshShape> shape;
    float roughness;
    bool has_edges;                                  // sharp ones: vertices have no normals
    std::shared_ptr<const EdgeBars> bars = nullptr;  // in place of the surface; of all copies
  };
  static Look look(const scenes::BodyScene& body,
                   const std::shared_ptr<const render::MeshShape>& shape, bool has_edges,
                   double extent);
  static render::Mesh as_seen(render::Mesh mesh, const Look& look);

  std::string title_;
  bool caption_ = false;
  int time_digits_ = 2;     // on the caption
  bool pressures_ = false;  // on the caption
  bool rounded_ = true;
  render::Frame scenery_;          // all that is the same in every frame
  std::vector<Look> soft_looks_;   // as World::soft
  std::vector<Look> rigid_looks_;  // as World::rigid
  JointMeshes joints_;
};

}  // namespace pneuma::app
