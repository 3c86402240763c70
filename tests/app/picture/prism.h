// A shape that is round but for two sharp rims.
#pragma once

#include <cmath>
#include <numbers>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::app {

/// A prism of 24 sides, of radius 1 m, which turn by 15 degrees from one to the next.
inline sim::TriangleMesh make_prism(double height) {
  constexpr int sides = 24;
  sim::TriangleMesh mesh;
  mesh.vertices.resize(2 * sides + 2);
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    mesh.vertices[sim::at(i)] = sim::Vec3(std::cos(angle), std::sin(angle), 0.0);
    mesh.vertices[sim::at(sides + i)] = sim::Vec3(std::cos(angle), std::sin(angle), height);
    const int next = (i + 1) % sides;
    mesh.triangles.push_back({i, next, sides + next});
    mesh.triangles.push_back({i, sides + next, sides + i});
    mesh.triangles.push_back({2 * sides, next, i});
    mesh.triangles.push_back({2 * sides + 1, sides + i, sides + next});
  }
  mesh.vertices[2 * sides] = sim::Vec3::Zero();
  mesh.vertices[2 * sides + 1] = sim::Vec3(0.0, 0.0, height);
  return mesh;
}

}  // namespace pneuma::app
