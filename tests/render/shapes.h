// Meshes for the renderer's tests.
#pragma once

#include "render/frame/frame.h"

namespace pneuma::render {

/// A ball of rings x 2 rings faces with smooth normals.
Mesh make_ball(const Vec3f& centre, float radius, const Colour& colour, int rings = 24);

/// A ring around the z axis of so many faces around it and around its tube with smooth normals,
/// coloured from `top` to `foot`.
Mesh make_ring(const Vec3f& centre, float radius, float thickness, const Colour& top,
               const Colour& foot, int around_count = 48, int tube_count = 20);

/// A box along the axes, without normals (flat), with its twelve edges.
Mesh make_box(const Vec3f& centre, const Vec3f& size, const Colour& colour);

/// A box seen by its looks only: turned by `turn`, coloured corner by corner.
Mesh make_painted_box(const Vec3f& centre, float size, float turn);

}  // namespace pneuma::render
