#include "sim/response/keep_volume.h"

#include "sim/mesh/measure.h"

namespace pneuma::sim {
namespace {

constexpr double least_share = 0.01;
constexpr int greatest_halvings = 30;

}  // namespace

void keep_volume(const MeshTopology& topology, const VertexArray& before, VertexArray& positions) {
  const double least = least_share * volume(topology, before);
  for (int i = 0; i < greatest_halvings; ++i) {
    if (volume(topology, positions) >= least) return;
    positions.rows() = 0.5 * (positions.rows() + before.rows());
  }
  positions.rows() = before.rows();
}

}  // namespace pneuma::sim
