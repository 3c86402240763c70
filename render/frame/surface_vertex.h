// What is drawn at a point of a surface, before light.
#pragma once

#include <Eigen/Core>

#include "render/frame/frame.h"

namespace pneuma::render {

struct SurfaceVertex {
  Vec3f position;
  Vec3f normal;              // unit
  float flatness;            // squared cosine between that and the facet at it that differs most
  Eigen::Vector4f material;  // linear colour, roughness
};

}  // namespace pneuma::render
