// The project's own meshes in assets/, read without the importer.
#pragma once

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>

#include "sim/mesh/triangle_mesh.h"
#include "tests/support/paths.h"

namespace pneuma {

/// Text PLY: header lines up to end_header, then rows of numbers. Throws when it ends early.
inline sim::TriangleMesh parse_plain_ply(const std::string& text) {
  std::istringstream file(text);
  std::size_t vertices = 0, triangles = 0;
  for (std::string line; std::getline(file, line) && line != "end_header";) {
    std::istringstream words(line);
    std::string word, kind;
    words >> word >> kind;
    if (word == "element") words >> (kind == "vertex" ? vertices : triangles);
  }
  sim::TriangleMesh mesh{std::vector<sim::Vec3>(vertices), std::vector<sim::Triangle>(triangles)};
  for (sim::Vec3& v : mesh.vertices) file >> v.x() >> v.y() >> v.z();
  int corners = 3;
  for (auto& [a, b, c] : mesh.triangles) file >> corners >> a >> b >> c;
  if (!file) throw std::runtime_error("the mesh file ends early");
  return mesh;
}

/// The whole file of that name in assets/.
inline std::string read_asset(const std::string& name) {
  std::ifstream file(project_folder() / "assets" / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace pneuma
