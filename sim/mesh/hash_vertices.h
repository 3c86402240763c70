// Hashes of vectors and of all vertices of a body.
#pragma once

#include "sim/base/hash.h"
#include "sim/mesh/triangle_mesh.h"
#include "sim/mesh/vertex_array.h"

namespace pneuma::sim {

inline void add(base::Hash& hash, const Vec3& vector) {
  for (const double value : vector) hash.add(value);
}

inline void add(base::Hash& hash, const VertexArray& values) {
  for (int i = 0; i < values.size(); ++i) add(hash, Vec3(values[i]));
}

}  // namespace pneuma::sim
