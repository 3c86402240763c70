// The light that the ground z = 0 gets, and what of it a surface above sees.
#pragma once

#include "render/geometry/drawn_surface.h"
#include "render/light/environment.h"

namespace pneuma::render {

/// The light of the open ground by where it comes from, each channel as a fraction of it; the last
/// channel is of no use.
struct GroundLight {
  Eigen::Array4f sky;
  Eigen::Array4f sun;
  Light3 of_sky;  // over pi, linear

  explicit GroundLight(const Vec3f& to_light);

  /// What comes of sky and bodies. Three hundredths of the sky are not seen to be missing of an
  /// open one, and no ground is drawn brighter than the open one.
  Eigen::Array4f ambient(const IndirectLight& left) const;
};

/// The middle of what a surface sees of the ground, in heights of the surface: how far it is ahead
/// of the surface's foot, the way the normal points, and how far from the surface itself.
struct SeenGround {
  float ahead;
  float distance;
};

/// Of a surface whose unit normal has the z component `nz`. At most ten heights away.
///
/// In the plane of the normal and straight down, at an angle a from there, the surface sees the
/// ground between a - 90 and 90 degrees. The part up to the angle m sends 1 + sin(m - a) out of
/// 1 + cos(a); half of it comes from up to m = a - asin((1 - cos(a)) / 2).
SeenGround seen_ground(float nz);

/// That middle, of a surface at a point; of one below the ground its foot.
Vec3f seen_on_ground(const Vec3f& position, const Vec3f& normal);

}  // namespace pneuma::render
