// Where something is wrong with a model, for messages.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "assets/model.h"
#include "assets/surface.h"

namespace pneuma::assets {

inline constexpr std::size_t most_places = 5;

/// Triangles on their way to a clean mesh, with the numbers that they had in the input.
struct NumberedMesh {
  sim::TriangleMesh mesh;
  std::vector<int> vertex_number;    // of each vertex, in the input
  std::vector<int> triangle_number;  // of each triangle, in the input
};

/// "(1, 0.5, -2)".
std::string coordinates(const Vec3& point);

/// "vertex 3 at (0, 0, 1)".
std::string vertex_place(const NumberedMesh& mesh, int vertex);

/// "edge 3-7 from (0, 0, 1) to (1, 0, 1)".
std::string edge_place(const NumberedMesh& mesh, const Edge& edge);

/// "triangle 5 at (0, 0, 1)", its middle.
std::string triangle_place(const NumberedMesh& mesh, int triangle);

/// "; the first: a; b; c", or for one or none of more "; it is a". `count` is of all, `place`
/// names one.
std::string first_places(std::size_t count, const std::function<std::string(std::size_t)>& place);

/// first_places of vertices.
std::string vertex_places(const NumberedMesh& mesh, const std::vector<int>& vertices);

/// Of the bounding box.
double diagonal_of(const std::vector<Vec3>& vertices);

/// "1 vertex", "2 vertices".
std::string counted(std::size_t count, std::string_view one, std::string_view many);

}  // namespace pneuma::assets
