#include "sim/soft/spring_force.h"

#include "sim/mesh/edge_length.h"
#include "sim/mesh/vec4d.h"

namespace pneuma::sim {
namespace {

/// Edges at a time: the lanes of a Vec4d.
constexpr int lanes = 4;

/// The edges' vectors b - a, or the differences of their ends' velocities. Always inline: as a
/// call, which is what GCC would make of it, it adds half to the time of the whole loop.
[[gnu::always_inline]] inline Vec3x4 differences(const ForceTables::Ends* ends,
                                                 const double* rows) {
  const auto difference = [ends, rows](int i) {
    return load_vec4d(rows + ends[i].to) - load_vec4d(rows + ends[i].from);
  };
  return to_columns(difference(0), difference(1), difference(2), difference(3));
}

Vec3 difference(const ForceTables::Ends& ends, const double* rows) {
  return Eigen::Map<const Vec3>(rows + ends.to) - Eigen::Map<const Vec3>(rows + ends.from);
}

/// spring_coefficient() four at a time, as (k / l^2) (l (l - L) + c/k v_rel . e).
struct SpringLoop {
  const ForceTables::Ends* edges;
  const double* positions;
  const double* velocities;
  const double* rest_lengths;
  double k;
  double dashpot_over_k;

  struct Four {
    Vec4d squared_length;
    Vec4d parting;  // v_rel . e
  };

  template <bool damped>
  Four measure(int edge) const {
    const Vec3x4 e = differences(edges + edge, positions);
    Four four{squared_length(e.x, e.y, e.z), {}};
    if constexpr (damped) {
      const Vec3x4 v_rel = differences(edges + edge, velocities);
      four.parting = fma(v_rel.x, e.x, fma(v_rel.y, e.y, v_rel.z * e.z));
    }
    return four;
  }

  /// Roots and quotients take long: meanwhile the next four edges are measured. Returns how many
  /// edges are done, a multiple of four.
  template <bool damped>
  int run(int count, double* coefficients) const {
    const int end = count - count % lanes;
    if (end == 0) return 0;
    Four four = measure<damped>(0);
    for (int edge = 0; edge < end; edge += lanes) {
      const Vec4d length = square_root(four.squared_length);
      const Vec4d factor = k / four.squared_length;
      const Four next = measure<damped>(edge + lanes < end ? edge + lanes : edge);
      Vec4d pull = length * (length - load_vec4d(rest_lengths + edge));
      if constexpr (damped) pull = fma(dashpot_over_k, four.parting, pull);
      store_vec4d(factor * pull, coefficients + edge);
      four = next;
    }
    return end;
  }
};

}  // namespace

double spring_coefficient(const Vec3& edge, const Vec3& relative_velocity, double rest_length,
                          double k, double dashpot) {
  const double length = edge_length(edge);
  const double pull = k * (length - rest_length) + dashpot * relative_velocity.dot(edge) / length;
  return pull / length;
}

void spring_coefficients(const SoftMesh& mesh, const VertexArray& positions,
                         const VertexArray& velocities, double k, double dashpot,
                         std::span<double> coefficients) {
  const SpringLoop loop{.edges = mesh.tables.edges.data(),
                        .positions = positions.rows().data(),
                        .velocities = velocities.rows().data(),
                        .rest_lengths = mesh.rest_lengths.data(),
                        .k = k,
                        .dashpot_over_k = dashpot / k};
  const int count = mesh.topology.edge_count();
  const int done = dashpot > 0.0 ? loop.run<true>(count, coefficients.data())
                                 : loop.run<false>(count, coefficients.data());
  for (std::size_t e = at(done); e < coefficients.size(); ++e) {
    const ForceTables::Ends& ends = mesh.tables.edges[e];
    coefficients[e] =
        spring_coefficient(difference(ends, loop.positions), difference(ends, loop.velocities),
                           mesh.rest_lengths[e], k, dashpot);
  }
}

double spring_energy(const SoftMesh& mesh, const VertexArray& positions, double k) {
  const ForceTables::Ends* const edges = mesh.tables.edges.data();
  const double* const rows = positions.rows().data();
  const int count = mesh.topology.edge_count();
  const int done = count - count % lanes;
  Vec4d squares{};
  for (int edge = 0; edge < done; edge += lanes) {
    const Vec3x4 e = differences(edges + edge, rows);
    const Vec4d strain =
        square_root(squared_length(e.x, e.y, e.z)) - load_vec4d(mesh.rest_lengths.data() + edge);
    squares = fma(strain, strain, squares);
  }
  double sum = sum_of_lanes(squares);
  for (int edge = done; edge < count; ++edge) {
    const double strain = edge_length(difference(edges[edge], rows)) - mesh.rest_lengths[at(edge)];
    sum += strain * strain;
  }
  return 0.5 * k * sum;
}

}  // namespace pneuma::sim
