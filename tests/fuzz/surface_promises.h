// Whether a surface is what clean_mesh promises, found out by other means than its own.
#pragma once

#include <string>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::fuzz {

/// What is wrong with a surface that should be closed, manifold, in one piece, outwards and free of
/// itself, with finite coordinates and a volume; empty when nothing is. Every pair of triangles is
/// looked at: for small meshes.
std::string broken_promise(const sim::TriangleMesh& mesh);

}  // namespace pneuma::fuzz
