#include "sim/mesh/measure.h"

#include <algorithm>

#include "sim/mesh/vec4d.h"

namespace pneuma::sim {

Bounds bounds(const VertexArray& positions) {
  if (positions.size() == 0) return {};
  const VertexReader x(positions);
  Vec4d low = x[0], high = x[0];
  for (int i = 1; i < positions.size(); ++i) {
    low = min(low, x[i]);
    high = max(high, x[i]);
  }
  return {to_vec3(low), to_vec3(high)};
}

Vec3 mean(const VertexArray& values) {
  const Eigen::Vector4d sum = values.rows().rowwise().sum();
  return sum.head<3>() / values.size();
}

double radius(const VertexArray& positions) {
  const Vec3 centre = mean(positions);
  double greatest = 0.0;
  for (int v = 0; v < positions.size(); ++v) {
    greatest = std::max(greatest, (Vec3(positions[v]) - centre).norm());
  }
  return greatest;
}

// Of two triangles a b c and a c d the sum a . (b x c) + a . (c x d) is a . ((b - d) x c).
double volume(const MeshTopology& topology, const VertexArray& positions) {
  const double* const rows = positions.rows().data();
  const Vec4d origin = load_vec4d(rows);
  Vec4d six_volumes{};
  for (const auto& [first, second, third, fourth] : topology.quadrangles()) {
    const Vec4d a = origin - load_vec4d(rows + first), c = origin - load_vec4d(rows + third);
    const Vec4d across = load_vec4d(rows + second) - load_vec4d(rows + fourth);
    six_volumes = fma(a, cross(across, c), six_volumes);
  }
  return sum_of_lanes(six_volumes) / 6.0;
}

Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c) { return 0.5 * (b - a).cross(c - a); }

double surface_area(const MeshTopology& topology, const VertexArray& positions) {
  double area = 0.0;
  for (const auto& [a, b, c] : topology.triangles()) {
    area += area_vector(positions[a], positions[b], positions[c]).norm();
  }
  return area;
}

void vertex_normals(const MeshTopology& topology, const VertexArray& positions,
                    std::vector<Vec3>& normals) {
  normals.assign(at(topology.vertex_count()), Vec3::Zero());
  for (const auto& [a, b, c] : topology.triangles()) {
    const Vec3 area = area_vector(positions[a], positions[b], positions[c]);
    normals[at(a)] += area;
    normals[at(b)] += area;
    normals[at(c)] += area;
  }
  for (Vec3& normal : normals) {
    const double length = normal.norm();
    normal = length > 0.0 ? Vec3(normal / length) : Vec3::UnitZ();
  }
}

VertexArray to_vertex_array(const std::vector<Vec3>& points) {
  VertexArray result(static_cast<int>(points.size()));
  for (int i = 0; i < result.size(); ++i) result[i] = points[at(i)];
  return result;
}

}  // namespace pneuma::sim
