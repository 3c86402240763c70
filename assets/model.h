// A triangle model as a file holds it: plain data, nothing of it checked.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::assets {

using sim::Triangle;
using sim::Vec3;

/// A model that cannot be used or read. The message says what is wrong and where, and what to do.
struct ModelError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Model {
  sim::TriangleMesh mesh;  // in the file's own units and axes

  // The objects that the file is made of, if it says. Empty, or `parts` has one number per
  // triangle, an index into `part_names`.
  std::vector<int> parts;
  std::vector<std::string> part_names;

  // The file's vertices, where the importer gives them otherwise: how many there are, and for each
  // vertex of the mesh its number there, as people count in that format. 0 and empty: as the mesh.
  int vertices_in_file = 0;
  std::vector<int> vertex_numbers = {};
};

}  // namespace pneuma::assets
