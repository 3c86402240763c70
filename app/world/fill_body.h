// How much gas a soft body has: by n, by its pressure, or by the volume that it is to settle at.
#pragma once

#include <memory>
#include <numbers>

#include "scenes/loader/scene.h"

namespace pneuma::app {

/// k over a skin's stiffness: a sheet of equilateral triangles of springs has Young's modulus
/// 2 k / sqrt 3 per width, however small they are (Seung and Nelson 1988, "Defects in flexible
/// membranes with crystalline order").
inline constexpr double k_per_stiffness = 0.5 * std::numbers::sqrt3;

/// The body's material with its gas: n, the volume at which it has its temperature, and what is
/// outside. `mesh` has the springs at rest in the shape, which needs a volume if there is to be
/// gas. Throws scenes::SceneError when no amount of gas gives the inflation that is asked for.
sim::SoftMaterial filled_material(const scenes::Scene& scene, const scenes::BodyScene& body,
                                  const std::shared_ptr<const sim::SoftMesh>& mesh);

}  // namespace pneuma::app
