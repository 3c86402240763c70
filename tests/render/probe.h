// Questions that tests ask of pictures.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>

#include "render/frame/frame.h"
#include "render/image/image.h"
#include "render/renderer.h"

namespace pneuma::render {

using Pixel = std::array<int, 3>;

/// Column x from the left, row y from the top.
Pixel pixel_at(const Image& image, int x, int y);

/// Where a point is seen, in pixels from the upper left corner (a pixel's centre is at .5), worked
/// out by similar triangles and in double precision, without the renderer's matrices.
Eigen::Vector2d seen_at(const Camera& camera, const Vec3f& point, int width, int height);

/// The pixel that holds the point.
Pixel pixel_of(const Image& image, const Camera& camera, const Vec3f& point);

int greatest_difference(const Pixel& a, const Pixel& b);

/// Calls `visit(x, y)` for each pixel in which the two differ.
void for_each_difference(const Image& a, const Image& b,
                         const std::function<void(int, int)>& visit);
int count_differences(const Image& a, const Image& b);

/// A picture by a renderer of its own.
Image draw_once(const Frame& frame, const RenderOptions& options);

/// 320 x 240 pixels.
RenderOptions small_picture(int samples = 1);

/// Nothing but the background: no ground, no shadows, the camera at (0, -10, 0) looking along +y.
Frame empty_frame();

}  // namespace pneuma::render
