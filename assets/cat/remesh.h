// Isotropic remeshing (Botsch & Kobbelt, "A remeshing approach to multiresolution modeling", 2004):
// split long edges, collapse short ones, flip towards six neighbours, and let the vertices slide
// along the surface to even spacing, over and over.
#pragma once

#include <functional>

#include "assets/simplify/editable_mesh.h"

namespace pneuma::assets {

/// The surface that a mesh is to follow, and how finely.
struct RemeshTarget {
  std::function<Vec3(const Vec3&)> project;        // onto the surface
  std::function<double(const Vec3&)> edge_length;  // wanted there, m
};

/// A closed mesh near the surface, with every vertex on it and edges as long as wanted.
sim::TriangleMesh remesh(const sim::TriangleMesh& rough, const RemeshTarget& target);

}  // namespace pneuma::assets
