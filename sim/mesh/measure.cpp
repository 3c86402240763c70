#include "sim/mesh/measure.h"

#include "sim/mesh/row.h"

namespace pneuma::sim {
Bounds bounds(const VertexArray& positions) {
  Bounds result;
  for (int i = 0; i < positions.size(); ++i) result.include(positions[i]);
  return result;
}

Vec3 mean(const VertexArray& values) {
  const Eigen::Vector4d sum = values.rows().rowwise().sum();
  return sum.head<3>() / values.size();
}

double volume(const MeshTopology& topology, const VertexArray& positions) {
  Eigen::Vector4d centre = Eigen::Vector4d::Zero();
  centre.head<3>() = mean(positions);
  const Row origin = load_row(centre.data());
  const RowReader x(positions);
  Row six_volumes{};
  for (const auto& [first, second, third] : topology.triangles()) {
    const Row a = x[first] - origin, b = x[second] - origin, c = x[third] - origin;
    six_volumes += a * turned(b * turned(c) - turned(b) * c);  // a . (b x c), lane by lane
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
