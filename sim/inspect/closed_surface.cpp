#include "sim/inspect/closed_surface.h"

#include "sim/collision/oriented_box.h"

namespace pneuma::sim {
namespace {

base::Point to_point(const Vec3& place) { return {place.x(), place.y(), place.z()}; }

/// The box's corners i and i + 2^axis of each i without that bit.
std::vector<std::array<int, 2>> box_edges() {
  std::vector<std::array<int, 2>> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 8; ++i) {
      if ((i >> axis & 1) == 0) edges.push_back({i, i | 1 << axis});
    }
  }
  return edges;
}

std::vector<Triangle> box_triangles() {
  std::vector<Triangle> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, far = 1 << axis;
    triangles.push_back({far, far + u, far + u + v});
    triangles.push_back({far, far + u + v, far + v});
    triangles.push_back({0, u + v, u});
    triangles.push_back({0, v, u + v});
  }
  return triangles;
}

}  // namespace

ClosedSurface closed_surface(const SoftBody& body) {
  ClosedSurface surface;
  surface.points.reserve(at(body.positions.size()));
  for (int v = 0; v < body.positions.size(); ++v) {
    surface.points.push_back(to_point(body.positions[v]));
  }
  surface.edges = body.mesh->topology.edges();
  surface.triangles = body.mesh->topology.triangles();
  return surface;
}

ClosedSurface closed_surface(const RigidBox& box) {
  ClosedSurface surface;
  for (const Vec3& corner :
       corners({box.position, box.orientation.toRotationMatrix(), 0.5 * box.size})) {
    surface.points.push_back(to_point(corner));
  }
  surface.edges = box_edges();
  surface.triangles = box_triangles();
  return surface;
}

std::vector<ClosedSurface> closed_surfaces(const World& world) {
  std::vector<ClosedSurface> surfaces;
  for (const SoftBody& body : world.soft) surfaces.push_back(closed_surface(body));
  for (const RigidBox& box : world.rigid) surfaces.push_back(closed_surface(box));
  return surfaces;
}

const std::string& body_name(const World& world, int body) {
  const std::size_t soft = world.soft.size();
  return at(body) < soft ? world.soft[at(body)].name : world.rigid[at(body) - soft].name;
}

}  // namespace pneuma::sim
