#include <algorithm>

#include "sim/collision/bounding_sphere.h"
#include "sim/collision/point_in_body.h"
#include "sim/collision/separating_axis.h"
#include "sim/inspect/inspect.h"

namespace pneuma::sim {
namespace {

/// What of a world the tests look at again and again.
struct Shapes {
  explicit Shapes(const World& world) {
    for (const SoftBody& body : world.soft) {
      surfaces.push_back({body.mesh->topology, body.positions});
      surface_bounds.push_back(bounds(body.positions));
      spheres.push_back(bounding_sphere(body.positions, surface_bounds.back(), 0.0));
    }
    for (const RigidBox& box : world.rigid) {
      boxes.push_back({box.position, box.orientation.toRotationMatrix(), 0.5 * box.size});
      spheres.push_back(bounding_sphere(boxes.back(), 0.0));
    }
  }

  std::vector<SurfaceView> surfaces;
  std::vector<Bounds> surface_bounds;
  std::vector<OrientedBox> boxes;
  std::vector<BoundingSphere> spheres;  // of the soft bodies, then of the boxes
};

double depth_in_soft(const Shapes& shapes, int soft, const Vec3& point) {
  const auto exit =
      find_surface_exit(shapes.surfaces[at(soft)], shapes.surface_bounds[at(soft)], point);
  return exit ? exit->depth : 0.0;
}

double vertices_in_soft(const Shapes& shapes, int vertices_of, int soft) {
  const VertexArray& vertices = shapes.surfaces[at(vertices_of)].positions;
  double depth = 0.0;
  for (int v = 0; v < vertices.size(); ++v) {
    depth = std::max(depth, depth_in_soft(shapes, soft, vertices[v]));
  }
  return depth;
}

double soft_and_box(const Shapes& shapes, int soft, const OrientedBox& box) {
  const VertexArray& vertices = shapes.surfaces[at(soft)].positions;
  double depth = 0.0;
  for (int v = 0; v < vertices.size(); ++v) {
    if (const auto exit = find_box_exit(box, vertices[v])) depth = std::max(depth, exit->depth);
  }
  for (int i = 0; i < 8; ++i) {
    depth = std::max(depth, depth_in_soft(shapes, soft, box.corner(i)));
  }
  return depth;
}

double box_and_box(const OrientedBox& first, const OrientedBox& second) {
  const auto overlap = find_least_overlap(first, second);
  return overlap ? overlap->overlap : 0.0;
}

double depth_of_pair(const Shapes& shapes, const BodyPair& pair) {
  const int soft = static_cast<int>(shapes.surfaces.size());
  const auto box = [&](int body) -> const OrientedBox& { return shapes.boxes[at(body - soft)]; };
  if (pair.second < soft) {
    return std::max(vertices_in_soft(shapes, pair.first, pair.second),
                    vertices_in_soft(shapes, pair.second, pair.first));
  }
  if (pair.first < soft) return soft_and_box(shapes, pair.first, box(pair.second));
  return box_and_box(box(pair.first), box(pair.second));
}

}  // namespace

double greatest_penetration(const World& world) {
  double depth = 0.0;
  if (world.settings.ground) depth = std::max(depth, -bounds(world).low.z());

  const Shapes shapes(world);
  std::vector<BodyPair> pairs;
  PairFinder().find(shapes.spheres, pairs);
  for (const BodyPair& pair : pairs) depth = std::max(depth, depth_of_pair(shapes, pair));
  return depth;
}

}  // namespace pneuma::sim
