// The cat as meshes, and as the files in assets/.
#pragma once

#include <array>
#include <string>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::assets {

struct CatSize {
  const char* file;    // in assets/
  double edge_length;  // on the trunk, m
};

/// About 500, 2,000 and 8,000 vertices.
inline constexpr std::array<CatSize, 3> cat_sizes = {
    {{"cat_500.ply", 0.1335}, {"cat_2000.ply", 0.068}, {"cat_8000.ply", 0.0345}}};

/// Stands on z = 0, nose towards +x, about 2 m long and 1.65 m high with its tail.
sim::TriangleMesh make_cat(double edge_length);

/// ASCII PLY with coordinates in whole micrometres: what differs between compilers beyond that
/// cannot be seen in the file.
std::string write_ply(const sim::TriangleMesh& mesh);

}  // namespace pneuma::assets
