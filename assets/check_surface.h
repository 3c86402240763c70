// The demands on the surface of a soft body.
#pragma once

#include <vector>

#include "assets/places.h"

namespace pneuma::assets {

/// Throws ModelError that names every kind of fault there is, each with its count and first places:
/// boundary edges, non-manifold edges and vertices, and triangles lower than `min_height`.
void check_manifold(const NumberedMesh& mesh, const std::vector<Edge>& edges, double min_height);

/// Throws ModelError when two triangles touch beyond what they share.
void check_self_touching(const NumberedMesh& mesh);

}  // namespace pneuma::assets
