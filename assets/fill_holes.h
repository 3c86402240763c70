// Small holes of a surface.
#pragma once

#include <string>
#include <vector>

#include "assets/places.h"

namespace pneuma::assets {

/// Fills each hole whose rim has at most 500 edges by the triangles between its vertices that have
/// the least area in all (Barequet and Sharir, "Filling gaps in the boundary of a polyhedron",
/// 1995), if that is at most a quarter of the area of the surface that the hole is in. No edge may
/// have more than two triangles, and at no vertex may several fans meet. Returns what it did, in
/// plain words.
std::vector<std::string> fill_holes(NumberedMesh& mesh);

/// Of a surface whose holes fill_holes has left: why, and what it closes.
std::string why_holes_are_left(const std::vector<Edge>& edges);

}  // namespace pneuma::assets
