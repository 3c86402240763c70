// The cat as a solid: where its surface is, and how finely each part of it wants to be meshed.
//
// Metres; it stands on four feet on z = 0, its nose towards +x, and is as good as symmetric about y
// = 0. Only + - * / and square roots are used, which IEEE 754 rounds in one way everywhere, so that
// every compiler gives the same cat.
#pragma once

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::assets {

using sim::Vec3;

/// A distance and its derivative with respect to the point it is taken at.
struct Distance {
  double value;
  Vec3 gradient;
};

/// Negative inside, zero on the surface, about the distance in its neighbourhood; the gradient
/// points outwards and its length is near one.
Distance cat_distance(const Vec3& point);

/// The nearest surface point, for points near the surface.
Vec3 project_to_cat(const Vec3& point);

/// The wanted edge length there as a fraction of that on the trunk, 0..1: thin parts get shorter
/// ones.
double cat_spacing(const Vec3& point);

/// A box around the cat with some air: low corner and full lengths.
struct CatBox {
  Vec3 low = {-1.3, -0.6, -0.2};
  Vec3 size = {2.6, 1.2, 2.1};
};

}  // namespace pneuma::assets
