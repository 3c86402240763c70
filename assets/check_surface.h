// The demands on the surface of a soft body.
#pragma once

#include <vector>

#include "assets/places.h"

namespace pneuma::assets {

/// Throws ModelError that names every kind of fault there is, each with its count and first places:
/// boundary edges, non-manifold edges and vertices, and triangles lower than `min_height`. Says
/// that repair may help, unless the mesh `was_repaired`.
void check_manifold(const NumberedMesh& mesh, const std::vector<Edge>& edges, double min_height,
                    bool was_repaired);

/// Throws ModelError when two triangles touch beyond what they share.
void check_self_touching(const NumberedMesh& mesh, bool was_repaired);

}  // namespace pneuma::assets
