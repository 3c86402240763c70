// What all passes need to know of the frame at hand.
#pragma once

#include <span>

#include "render/frame/camera.h"
#include "render/frame/frame.h"
#include "render/frame/surface_vertex.h"

namespace pneuma::render {

struct View {
  Mat4f view;
  Mat4f projection;
  Mat4f view_projection;
  Vec3f eye;
  Vec3f target;
  Vec3f to_light;            // unit
  Box casters;               // around all meshes; empty when there are none
  float nearest = 0.0f;      // m before the eye: no mesh, point or line is nearer
  float near = 0.0f;         // m before the eye: what is nearer is not drawn
  float far = 0.0f;          // m before the eye
  int width = 0;             // pixels
  int height = 0;            // pixels
  float pixel_scale = 1.0f;  // pixels of this picture to one of a picture of 480 lines
};

/// The frame must have passed check_frame.
View make_view(const Frame& frame, int width, int height);

/// How far from the camera's target the ground reaches before it has faded away, in metres.
float ground_radius(const View& view);

/// m before the eye.
float depth(const View& view, const Vec3f& position);

/// Pixels.
Eigen::Vector2f picture_size(const View& view);

/// Pixels, from the picture's lower left corner.
struct Region {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// Around all that is drawn over ground and background, rather too large than too small: the whole
/// picture when more than surfaces are drawn.
Region region_of_bodies(const Frame& frame, const View& view,
                        std::span<const SurfaceVertex> surface);

/// sRGB to linear, one channel or colour.
float to_linear(float srgb);
Vec3f to_linear(const Colour& srgb);

}  // namespace pneuma::render
