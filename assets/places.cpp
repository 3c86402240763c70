#include "assets/places.h"

#include <fmt/format.h>

#include <algorithm>

namespace pneuma::assets {

using sim::at;

std::string coordinates(const Vec3& point) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", point.x(), point.y(), point.z());
}

std::string vertex_place(const NumberedMesh& mesh, int vertex) {
  return fmt::format("vertex {} at {}", mesh.vertex_number[at(vertex)],
                     coordinates(mesh.mesh.vertices[at(vertex)]));
}

std::string edge_place(const NumberedMesh& mesh, const Edge& edge) {
  const auto [a, b] = edge.vertices;
  return fmt::format("edge {}-{} from {} to {}", mesh.vertex_number[at(a)],
                     mesh.vertex_number[at(b)], coordinates(mesh.mesh.vertices[at(a)]),
                     coordinates(mesh.mesh.vertices[at(b)]));
}

std::string triangle_place(const NumberedMesh& mesh, int triangle) {
  const auto [a, b, c] = mesh.mesh.triangles[at(triangle)];
  const auto& vertices = mesh.mesh.vertices;
  const Vec3 middle = (vertices[at(a)] + vertices[at(b)] + vertices[at(c)]) / 3.0;
  return fmt::format("triangle {} at {}", mesh.triangle_number[at(triangle)], coordinates(middle));
}

std::string first_places(std::size_t count, const std::function<std::string(std::size_t)>& place) {
  std::string text = count > 1 ? "; the first: " : ": ";
  for (std::size_t i = 0; i < std::min(count, most_places); ++i) {
    if (i > 0) text += "; ";
    text += place(i);
  }
  return text;
}

std::string vertex_places(const NumberedMesh& mesh, const std::vector<int>& vertices) {
  return first_places(vertices.size(),
                      [&](std::size_t i) { return vertex_place(mesh, vertices[i]); });
}

double diagonal_of(const std::vector<Vec3>& vertices) {
  sim::Bounds box;
  for (const Vec3& vertex : vertices) box.include(vertex);
  return box.size().norm();
}

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace pneuma::assets
