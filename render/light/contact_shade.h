// The dark line where a body meets the ground.
//
// The elements of light/elements.h are too large to tell how near a surface comes to the ground
// next to the place where they touch. There the sky is seen through a wedge that closes; how far it
// has closed is taken from the height of the surface above the ground, averaged around a point.
#pragma once

#include <span>
#include <vector>

#include "render/frame/camera.h"
#include "render/geometry/drawn_surface.h"

namespace pneuma::render {

/// A picture of the ground: `world_to_picture` brings its points to 0..1 along both sides.
struct GroundPicture {
  Mat4f world_to_picture;
  int size;     // texels on a side
  float reach;  // m: surfaces higher than this are left out
};

/// For each texel, row by row, how near the nearest surface above or below it is: 1 where it
/// touches or goes through the ground, 0 from `reach` on, (1 - height / reach)^2 between.
/// `nearness` is resized. Whether any is not 0.
bool measure_nearness(std::span<const SurfaceVertex> vertices, std::span<const Triangle> triangles,
                      const GroundPicture& picture, std::vector<float>& nearness);

}  // namespace pneuma::render
