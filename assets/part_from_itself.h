// Small places at which a surface runs through itself.
#pragma once

#include <string>
#include <vector>

#include "assets/places.h"

namespace pneuma::assets {

/// Smooths a closed surface where it touches itself until it does not. Leaves it as it is where
/// that would take more than a twentieth of its vertices, or move one by more than a fiftieth of
/// the diagonal.
std::vector<std::string> part_from_itself(NumberedMesh& mesh);

}  // namespace pneuma::assets
