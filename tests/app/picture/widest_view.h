// How much of a picture bodies take.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/frame/camera.h"
#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// The largest of |x| and |y| in clip coordinates over all vertices: 1 is the picture's edge.
inline float widest_view(const scenes::Scene& scene, const sim::World& world,
                         const render::Camera& camera) {
  const float aspect =
      static_cast<float>(scene.picture.width) / static_cast<float>(scene.picture.height);
  const render::Mat4f to_clip =
      render::projection_matrix(camera.field_of_view, aspect, 0.1f, 1000.0f) *
      render::view_matrix(camera);
  float result = 0.0f;
  for (const sim::SoftBody& body : world.soft) {
    for (int v = 0; v < body.positions.size(); ++v) {
      const render::Vec3f point = sim::Vec3(body.positions[v]).cast<float>();
      const Eigen::Vector4f clip = to_clip * point.homogeneous();
      EXPECT_GT(clip.w(), 0.0f);  // in front of the camera
      result = std::max({result, std::abs(clip.x() / clip.w()), std::abs(clip.y() / clip.w())});
    }
  }
  return result;
}

}  // namespace pneuma::app
