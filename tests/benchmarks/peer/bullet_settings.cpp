#include "benchmarks/peer/bullet_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace pneuma::benchmarks {
namespace {

constexpr BulletOptions by_hand{.position_iterations = 2, .gas_fraction = 0.05};

struct SceneSetting {
  std::string_view scene;
  BulletOptions options;
};

/// Where the comment says so, nothing that was tried simulates the scene as ours.
constexpr auto scene_settings = std::to_array<SceneSetting>({
    {"one_sphere", {.link_stiffness = 0.03, .gas_fraction = 2.03, .voxel_size = 2.0, .drag = 0.05}},
    {"one_torus", {.link_stiffness = 0.4, .gas_fraction = 1.59}},
    {"two_spheres", {.link_stiffness = 0.1, .gas_fraction = 2.88, .voxel_size = 2.0, .drag = 0.05}},
    // What rests is not inflated.
    {"two_spheres_contact", {.substeps = 2, .gas_fraction = 3.53, .voxel_size = 4.0, .drag = 0.05}},
    {"three_spheres",
     {.link_stiffness = 0.1, .gas_fraction = 2.71, .voxel_size = 4.0, .drag = 0.05}},
    // What rests is not inflated.
    {"three_spheres_contact",
     {.substeps = 2, .gas_fraction = 3.55, .margin = 0.1, .voxel_size = 4.0, .drag = 0.05}},
    {"sphere_in_torus",
     {.substeps = 2,
      .link_stiffness = 0.01,
      .gas_fraction = 0.355,
      .margin = 0.1,
      .voxel_size = 4.0,
      .drag = 0.05}},
    // Corners of cubes get between the nodes: by 0.052 m.
    {"torus_four_cubes",
     {.position_iterations = 2,
      .substeps = 2,
      .link_stiffness = 0.05,
      .gas_fraction = 1.88,
      .voxel_size = 0.5}},
    // Corners and edges of cubes get between the nodes: by 1.6 m.
    {"cubes_on_torus",
     {.position_iterations = 4, .link_stiffness = 0.4, .gas_fraction = 4.75, .voxel_size = 0.5}},
});

const SceneSetting* find_setting(std::string_view scene) {
  const auto* const found = std::ranges::find(scene_settings, scene, &SceneSetting::scene);
  return found == scene_settings.end() ? nullptr : found;
}

}  // namespace

const BulletOptions& bullet_setting(std::string_view scene) {
  const SceneSetting* const found = find_setting(scene);
  return found == nullptr ? by_hand : found->options;
}

bool has_bullet_setting(std::string_view scene) { return find_setting(scene) != nullptr; }

std::string setting_text(const BulletOptions& options) {
  return fmt::format(
      "{} x {} iterations, kLST {:.3g}, gas {:.3g}, margin {:.3g} m, {} of {:.3g} m{}",
      options.substeps, options.position_iterations, options.link_stiffness, options.gas_fraction,
      options.margin, options.ground == BulletGround::box ? "box, voxels" : "plane, voxels",
      options.voxel_size, options.drag > 0.0 ? fmt::format(", drag {:.3g}", options.drag) : "");
}

}  // namespace pneuma::benchmarks
