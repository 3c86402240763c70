#include "sim/response/keep_volume.h"

#include "sim/mesh/measure.h"

namespace pneuma::sim {
namespace {

constexpr double min_volume_fraction = 0.01;
constexpr int max_volume_halvings = 30;

}  // namespace

void keep_volume(const MeshTopology& topology, const VertexArray& before, VertexArray& positions) {
  const double min_volume = min_volume_fraction * volume(topology, before);
  for (int i = 0; i < max_volume_halvings; ++i) {
    if (volume(topology, positions) >= min_volume) return;
    positions.rows() = 0.5 * (positions.rows() + before.rows());
  }
  positions.rows() = before.rows();
}

}  // namespace pneuma::sim
