// Shapes of flat faces and sharp edges, which are not to be drawn round.
#pragma once

#include "sim/mesh/soft_mesh.h"

namespace pneuma::app {

/// Whether the shape at rest has sharp edges and no others: all triangles next to each other lie
/// nearly in one plane or meet at 60 degrees and more, as of a cube, a letter or a house. Round
/// shapes have edges between, however coarse they are.
bool is_faceted(const sim::SoftMesh& mesh);

}  // namespace pneuma::app
