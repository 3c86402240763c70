#include "sim/soft/ring_forces.h"

#include <type_traits>

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {
namespace {

struct VertexForces {
  Vec4d springs;
  Vec4d six_volume_gradients;
};

/// A vertex and its ring.
struct Ring {
  const ForceTables::Spoke* spokes;
  const double* positions;
  const double* coefficients;
  Vec4d centre;

  /// From a neighbour to the vertex.
  Vec4d inward(int i) const { return centre - load_vec4d(positions + spokes[i].neighbour); }
  double coefficient(int i) const { return coefficients[spokes[i].edge]; }
};

/// A sum of cross products a x b = yzx(a yzx(b) - yzx(a) b). The outer turn is the same
/// for all and waits for the end of the sum.
struct CrossSum {
  Vec4d left{}, right{};

  void add(Vec4d a, Vec4d b) {
    left = fma(a, yzx(b), left);
    right = fma(yzx(a), b, right);
  }
  Vec4d value() const { return yzx(left - right); }
};

/// Six times dV/dx is twice the area vector of the polygon that the ring makes. Lines from its
/// first corner cut it into quadrangles and, if the number of corners is odd, a triangle; twice the
/// area vector of a quadrangle is the cross product of its diagonals. `Count` is int, or an
/// integral constant, for which the compiler unrolls the loop.
template <class Count>
VertexForces gather(const Ring& ring, Count count) {
  const Vec4d first = ring.inward(0);
  Vec4d previous = ring.inward(1);
  // Two sums, so that an addition need not wait for the one before.
  Vec4d even{}, odd{};
  even = fnma(ring.coefficient(0), first, even);
  odd = fnma(ring.coefficient(1), previous, odd);
  CrossSum twice_area;
  int i = 2;
  for (; i + 1 < count; i += 2) {
    const Vec4d here = ring.inward(i), next = ring.inward(i + 1);
    even = fnma(ring.coefficient(i), here, even);
    odd = fnma(ring.coefficient(i + 1), next, odd);
    twice_area.add(here - first, next - previous);
    previous = next;
  }
  if (i < count) {
    const Vec4d last = ring.inward(i);
    even = fnma(ring.coefficient(i), last, even);
    twice_area.add(previous - first, last - first);
  }
  return {even + odd, twice_area.value()};
}

}  // namespace

double gather_rings(const ForceTables& tables, const VertexArray& positions,
                    std::span<const double> coefficients, RingForces& forces) {
  const VertexReader x(positions);
  const VertexWriter out(forces.rows());
  const ForceTables::Spoke* const spokes = tables.spokes.data();
  const int* const rings_end = tables.rings_end.data();
  const int vertex_count = positions.size();

  // By Euler's theorem 3 V = sum (x - c) . dV/dx: V is homogeneous of degree three about any c.
  const Vec4d centre = x[0];
  Vec4d eighteen_volumes{};
  int begin = 0;
  for (int v = 0; v < vertex_count; ++v) {
    const int count = rings_end[v] - begin;
    const Ring ring{spokes + begin, positions.rows().data(), coefficients.data(), x[v]};
    begin = rings_end[v];
    // Nearly all vertices of a triangle mesh have six neighbours.
    const VertexForces sums =
        count == 6 ? gather(ring, std::integral_constant<int, 6>{}) : gather(ring, count);
    eighteen_volumes = fma(ring.centre - centre, sums.six_volume_gradients, eighteen_volumes);
    out.put(RingForces::springs(v), sums.springs);
    out.put(RingForces::six_volume_gradients(v), sums.six_volume_gradients);
  }
  return sum_of_lanes(eighteen_volumes) / 18.0;
}

}  // namespace pneuma::sim
