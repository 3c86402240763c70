// World -> Frame: what the renderer is to draw of a state of the simulation.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/picture/joint_meshes.h"
#include "render/frame/frame.h"
#include "scenes/loader/scene.h"
#include "sim/collision/contact.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// What a picture shows beside the surfaces.
struct Show {
  bool wireframe = false;
  bool particles = false;  // collision particles
  bool contacts = false;   // contact points and normals
};

/// What the pictures of a run show. With an overlay each frame is drawn twice, in two files.
struct Pictures {
  Show show;
  std::optional<Show> overlay;
};

/// The names of what is shown, as in `--show`.
std::vector<std::string> shown_names(Show show);

/// Reads the list of `option`, --show or --overlay: names separated by commas. Throws UsageError.
Show parse_show(const std::string& option, const std::string& list);

/// Turns the states of one world into frames. What stays the same over a run (triangles, edges,
/// colours) is made once and shared by all frames.
class FrameBuilder {
 public:
  /// `world` is the scene's world in any state.
  FrameBuilder(const scenes::Scene& scene, const sim::World& world, const render::Camera& camera);

  /// `contacts`: those of the step that led to this state.
  render::Frame build(const sim::World& world, std::span<const sim::Contact> contacts = {},
                      Show show = {}) const;

 private:
  struct Look {
    std::shared_ptr<const render::MeshShape> shape;
    float roughness;
  };

  std::string title_;
  bool caption_ = false;
  bool pressures_ = false;  // on the caption
  bool rounded_ = true;
  render::Frame scenery_;          // all that is the same in every frame
  std::vector<Look> soft_looks_;   // as World::soft
  std::vector<Look> rigid_looks_;  // as World::rigid
  JointMeshes joints_;
};

}  // namespace pneuma::app
