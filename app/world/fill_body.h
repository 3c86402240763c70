// How much gas a soft body has: by n, by its pressure, or by the volume that it is to settle at.
#pragma once

#include <memory>

#include "scenes/loader/scene.h"

namespace pneuma::app {

/// The body's material with its gas: n, the volume at which it has its temperature, and what is
/// outside. `mesh` has the springs at rest in the shape, which needs a volume if there is to be
/// gas. Throws scenes::SceneError when no amount of gas gives the inflation that is asked for.
sim::SoftMaterial filled_material(const scenes::Scene& scene, const scenes::BodyScene& body,
                                  const std::shared_ptr<const sim::SoftMesh>& mesh);

}  // namespace pneuma::app
