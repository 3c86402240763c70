#include "assets/cat/isosurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace pneuma::assets {
namespace {

using sim::at;

/// The six tetrahedra around a cube's diagonal (Kuhn), corner c at (c & 1, c >> 1 & 1, c >> 2).
/// Neighbouring cubes cut their common square along the same diagonal, so nothing is left open.
constexpr std::array<std::array<int, 4>, 6> tetrahedra = {
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

class Marcher {
 public:
  Marcher(const std::function<double(const Vec3&)>& distance, const CatBox& box, double cell)
      : low_(box.low), cell_(cell) {
    for (int axis = 0; axis < 3; ++axis) {
      count_[at(axis)] = static_cast<int>(std::ceil(box.size[axis] / cell)) + 1;
    }
    for (int point = 0; point < count_[0] * count_[1] * count_[2]; ++point) {
      values_.push_back(distance(place(point)));
    }
  }

  sim::TriangleMesh run() {
    for (int z = 0; z + 1 < count_[2]; ++z) {
      for (int y = 0; y + 1 < count_[1]; ++y) {
        for (int x = 0; x + 1 < count_[0]; ++x) cut_cube(x, y, z);
      }
    }
    return std::move(mesh_);
  }

 private:
  int index(int x, int y, int z) const { return x + count_[0] * (y + count_[1] * z); }

  Vec3 place(int point) const {
    const int x = point % count_[0];
    const int y = point / count_[0] % count_[1];
    const int z = point / count_[0] / count_[1];
    return low_ + cell_ * Vec3(x, y, z);
  }

  void cut_cube(int x, int y, int z) {
    std::array<int, 8> corners;
    for (int c = 0; c < 8; ++c) corners[at(c)] = index(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
    for (const auto& tetrahedron : tetrahedra) {
      std::array<int, 4> points;
      for (int i = 0; i < 4; ++i) points[at(i)] = corners[at(tetrahedron[at(i)])];
      cut_tetrahedron(points);
    }
  }

  void cut_tetrahedron(std::array<int, 4> points) {
    const auto inside = [this](int point) { return values_[at(point)] < 0.0; };
    std::stable_partition(points.begin(), points.end(), inside);
    const auto [a, b, c, d] = points;
    const Vec3 outwards = place(d) - place(a);
    switch (std::count_if(points.begin(), points.end(), inside)) {
      case 1:
        add({crossing(a, b), crossing(a, c), crossing(a, d)}, outwards);
        break;
      case 2:
        add({crossing(a, c), crossing(a, d), crossing(b, c)}, outwards);
        add({crossing(b, c), crossing(a, d), crossing(b, d)}, outwards);
        break;
      case 3:
        add({crossing(a, d), crossing(b, d), crossing(c, d)}, outwards);
        break;
      default:
        break;
    }
  }

  /// The surface vertex between two lattice points. Kept off both, so that no triangle vanishes:
  /// the remeshing puts it onto the surface.
  int crossing(int inside, int outside) {
    const auto [entry, added] = vertices_.try_emplace(std::minmax(inside, outside),
                                                      static_cast<int>(mesh_.vertices.size()));
    if (added) {
      const double depth = -values_[at(inside)];
      const double t = std::clamp(depth / (depth + values_[at(outside)]), 0.1, 0.9);
      mesh_.vertices.push_back(place(inside) + t * (place(outside) - place(inside)));
    }
    return entry->second;
  }

  void add(sim::Triangle triangle, const Vec3& outwards) {
    const auto [a, b, c] = triangle;
    const Vec3& corner = mesh_.vertices[at(a)];
    const Vec3 normal = (mesh_.vertices[at(b)] - corner).cross(mesh_.vertices[at(c)] - corner);
    if (normal.dot(outwards) < 0.0) std::swap(triangle[1], triangle[2]);
    mesh_.triangles.push_back(triangle);
  }

  Vec3 low_;
  double cell_;
  std::array<int, 3> count_ = {};
  std::vector<double> values_;
  std::map<std::pair<int, int>, int> vertices_;
  sim::TriangleMesh mesh_;
};

}  // namespace

sim::TriangleMesh isosurface(const std::function<double(const Vec3&)>& distance, const CatBox& box,
                             double cell) {
  return Marcher(distance, box, cell).run();
}

}  // namespace pneuma::assets
