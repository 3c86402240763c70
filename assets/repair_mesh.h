// Faults of a model's surface that can be mended by a guess, if its owner wishes.
#pragma once

#include <string>
#include <vector>

#include "assets/places.h"

namespace pneuma::assets {

/// Welds the two sides of cracks, drops fins (triangles that stand out of a closed surface), splits
/// vertices where fans of triangles meet, fills small holes (fill_holes.h), and takes triangles
/// without area, lower than `min_height`, out by turning their longest edge. Returns what it did
/// and where, in plain words. What it cannot mend it leaves to check_manifold.
std::vector<std::string> repair_mesh(NumberedMesh& mesh, double min_height);

}  // namespace pneuma::assets
