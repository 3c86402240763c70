#include "sim/mesh/primitives.h"

#include <cassert>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

namespace pneuma::sim {
namespace {

constexpr double pi = std::numbers::pi;

int count(const std::vector<Vec3>& vertices) { return static_cast<int>(vertices.size()); }

}  // namespace

TriangleMesh make_sphere(double radius, int stacks, int slices) {
  assert(stacks >= 2 && slices >= 3);
  TriangleMesh mesh;
  mesh.vertices.push_back({0.0, 0.0, radius});
  for (int stack = 1; stack < stacks; ++stack) {
    const double polar = pi * stack / stacks;
    for (int slice = 0; slice < slices; ++slice) {
      const double azimuth = 2.0 * pi * slice / slices;
      mesh.vertices.push_back(radius * Vec3(std::sin(polar) * std::cos(azimuth),
                                            std::sin(polar) * std::sin(azimuth), std::cos(polar)));
    }
  }
  mesh.vertices.push_back({0.0, 0.0, -radius});

  const int bottom = count(mesh.vertices) - 1;
  const auto id = [slices](int stack, int slice) {
    return 1 + (stack - 1) * slices + slice % slices;
  };
  for (int slice = 0; slice < slices; ++slice) {
    mesh.triangles.push_back({0, id(1, slice), id(1, slice + 1)});
    for (int stack = 1; stack < stacks - 1; ++stack) {
      mesh.triangles.push_back({id(stack, slice), id(stack + 1, slice), id(stack + 1, slice + 1)});
      mesh.triangles.push_back({id(stack, slice), id(stack + 1, slice + 1), id(stack, slice + 1)});
    }
    mesh.triangles.push_back({bottom, id(stacks - 1, slice + 1), id(stacks - 1, slice)});
  }
  return mesh;
}

TriangleMesh make_torus(double radius, double tube_radius, int stacks, int slices) {
  assert(stacks >= 3 && slices >= 3 && tube_radius < radius);
  TriangleMesh mesh;
  for (int stack = 0; stack < stacks; ++stack) {
    const double around = 2.0 * pi * stack / stacks;
    for (int slice = 0; slice < slices; ++slice) {
      const double tube = 2.0 * pi * slice / slices;
      const double distance = radius + tube_radius * std::cos(tube);
      mesh.vertices.push_back(
          {distance * std::cos(around), distance * std::sin(around), tube_radius * std::sin(tube)});
    }
  }
  const auto id = [=](int stack, int slice) { return (stack % stacks) * slices + slice % slices; };
  for (int stack = 0; stack < stacks; ++stack) {
    for (int slice = 0; slice < slices; ++slice) {
      mesh.triangles.push_back({id(stack, slice), id(stack + 1, slice), id(stack + 1, slice + 1)});
      mesh.triangles.push_back({id(stack, slice), id(stack + 1, slice + 1), id(stack, slice + 1)});
    }
  }
  return mesh;
}

TriangleMesh make_box(const Vec3& size, int divisions) {
  assert(divisions >= 1);
  TriangleMesh mesh;
  std::map<std::tuple<int, int, int>, int>
      index;  // lattice point to vertex: faces share their rims
  const auto vertex = [&](const Eigen::Vector3i& lattice) {
    const auto [entry, added] =
        index.try_emplace({lattice.x(), lattice.y(), lattice.z()}, count(mesh.vertices));
    if (added) {
      mesh.vertices.push_back(
          (lattice.cast<double>() / divisions - Vec3::Constant(0.5)).cwiseProduct(size));
    }
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3);
    const Eigen::Vector3i v = Eigen::Vector3i::Unit((axis + 2) % 3);
    for (const int side : {0, divisions}) {
      for (int i = 0; i < divisions; ++i) {
        for (int j = 0; j < divisions; ++j) {
          const Eigen::Vector3i corner = side * Eigen::Vector3i::Unit(axis) + i * u + j * v;
          const std::array<int, 4> quad = {vertex(corner), vertex(corner + u),
                                           vertex(corner + u + v), vertex(corner + v)};
          // The diagonal begins at quad[first].
          const std::size_t first = (2 * i < divisions) == (2 * j < divisions) ? 0 : 1;
          const int a = quad[first], b = quad[first + 1], c = quad[first + 2];
          const int d = quad[(first + 3) % 4];
          // u x v points along +axis: outward on the far side, reversed on the near one.
          if (side > 0) {
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
          } else {
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({a, d, c});
          }
        }
      }
    }
  }
  return mesh;
}

TriangleMesh make_icosphere(double radius, int subdivisions) {
  assert(subdivisions >= 0);
  const double phi = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, phi, 0}, {1, phi, 0}, {-1, -phi, 0}, {1, -phi, 0},
                   {0, -1, phi}, {0, 1, phi}, {0, -1, -phi}, {0, 1, -phi},
                   {phi, 0, -1}, {phi, 0, 1}, {-phi, 0, -1}, {-phi, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [entry, added] = middles.try_emplace(std::minmax(a, b), count(mesh.vertices));
      if (added) {
        mesh.vertices.push_back(mesh.vertices[at(a)] + mesh.vertices[at(b)]);
        mesh.vertices.back().normalize();
        mesh.vertices.back() *= mesh.vertices[0].norm();
      }
      return entry->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& vertex : mesh.vertices) vertex *= radius / vertex.norm();
  return mesh;
}

}  // namespace pneuma::sim
