// Shapes of flat faces and sharp edges, which are not to be drawn round.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/mesh/soft_mesh.h"

namespace pneuma::app {

/// Whether the shape at rest is bent at sharp edges for the most part: at 60 degrees and more, over
/// a quarter of the length of all edges whose triangles do not lie nearly in one plane, as of a
/// cube, a house or a part of a machine. Round shapes have edges between, however coarse they are.
bool is_faceted(const sim::SoftMesh& mesh);

/// Whether the edges of the shape at rest that are bent by 40 degrees and more, from which on
/// corner_normals parts their sides, mostly bound flat faces, as the rims of a long cylinder do. A
/// coarse animal has as sharp edges, but between faces that are bent on all sides.
bool has_flat_faces(const sim::SoftMesh& mesh);

/// As render::MeshShape::corner_normals: corners of one vertex have a normal in common if a way
/// around the vertex from one to the other crosses edges only that are bent by less than 40 degrees
/// in the shape at rest.
std::vector<std::array<std::uint32_t, 3>> corner_normals(const sim::SoftMesh& mesh);

}  // namespace pneuma::app
