#include <algorithm>

#include "sim/collision/find_body_contacts.h"
#include "sim/collision/point_in_body.h"
#include "sim/collision/separating_axis.h"
#include "sim/collision/surface_view.h"
#include "sim/collision/sweep_and_prune.h"
#include "sim/inspect/inspect.h"

namespace pneuma::sim {
namespace {

/// What of a world the tests look at again and again.
struct Shapes {
  explicit Shapes(const World& world) {
    for (const SoftBody& body : world.soft) {
      surfaces.push_back({body.mesh->topology, body.positions});
      columns.emplace_back().fill(surfaces.back());
      spheres.push_back(bounding_sphere(body.positions, columns.back().bounds(), 0.0));
    }
    for (const RigidBox& box : world.rigid) {
      boxes.push_back({box.position, box.orientation.toRotationMatrix(), 0.5 * box.size});
      spheres.push_back(bounding_sphere(boxes.back(), 0.0));
    }
  }

  std::vector<SurfaceView> surfaces;
  std::vector<TriangleColumns> columns;
  std::vector<OrientedBox> boxes;
  std::vector<BoundingSphere> spheres;  // of the soft bodies, then of the boxes
};

double depth_in_soft(const Shapes& shapes, int soft, const Vec3& point) {
  const auto exit = find_surface_exit(shapes.surfaces[at(soft)], shapes.columns[at(soft)], point);
  return exit ? exit->depth : 0.0;
}

/// Calls `look` with each vertex, the middle of each edge and of each triangle.
template <class Look>
void sample_surface(const SurfaceView& surface, const Look& look) {
  for (int feature = 0; feature < surface.topology.feature_count(); ++feature) {
    look(to_vec3(feature_centre(surface, feature)));
  }
}

/// Calls `look` with each corner and four points between the ends of each edge.
template <class Look>
void sample_box(const OrientedBox& box, const Look& look) {
  constexpr int parts = 5;
  for (int i = 0; i < 8; ++i) {
    look(box.corner(i));
    for (int axis = 0; axis < 3; ++axis) {
      const int other = i | 1 << axis;  // corners number their sides bit by bit
      if (other == i) continue;
      for (int part = 1; part < parts; ++part) {
        const double fraction = static_cast<double>(part) / parts;
        look(box.corner(i) + fraction * (box.corner(other) - box.corner(i)));
      }
    }
  }
}

double surface_in_soft(const Shapes& shapes, int inner, int soft) {
  double depth = 0.0;
  sample_surface(shapes.surfaces[at(inner)], [&](const Vec3& point) {
    depth = std::max(depth, depth_in_soft(shapes, soft, point));
  });
  return depth;
}

double soft_and_box(const Shapes& shapes, int soft, const OrientedBox& box) {
  double depth = 0.0;
  sample_surface(shapes.surfaces[at(soft)], [&](const Vec3& point) {
    if (const auto exit = find_box_exit(box, point)) depth = std::max(depth, exit->depth);
  });
  sample_box(
      box, [&](const Vec3& point) { depth = std::max(depth, depth_in_soft(shapes, soft, point)); });
  return depth;
}

double box_and_box(const OrientedBox& first, const OrientedBox& second) {
  const auto overlap = find_min_overlap(first, second);
  return overlap ? overlap->overlap : 0.0;
}

double depth_of_pair(const Shapes& shapes, const BodyPair& pair) {
  const int soft = static_cast<int>(shapes.surfaces.size());
  const auto box = [&](int body) -> const OrientedBox& { return shapes.boxes[at(body - soft)]; };
  if (pair.second < soft) {
    return std::max(surface_in_soft(shapes, pair.first, pair.second),
                    surface_in_soft(shapes, pair.second, pair.first));
  }
  if (pair.first < soft) return soft_and_box(shapes, pair.first, box(pair.second));
  return box_and_box(box(pair.first), box(pair.second));
}

/// The lowest of what may move, if it is below 0.
Overlap deepest_in_ground(const World& world) {
  Overlap deepest{0, ground_body, 0.0};
  const auto look_at = [&](int body, double low) {
    if (!is_kinematic(world, body) && -low > deepest.depth) deepest = {body, ground_body, -low};
  };
  const int soft = soft_count(world);
  for (int i = 0; i < soft; ++i) look_at(i, bounds(world.soft[at(i)].positions).low.z());
  for (int i = soft; i < body_count(world); ++i) {
    look_at(i, placed_box(world.rigid[at(i - soft)]).bounds.low.z());
  }
  return deepest;
}

}  // namespace

Overlap deepest_penetration(const World& world) {
  Overlap deepest;
  if (world.settings.ground) deepest = deepest_in_ground(world);
  const Shapes shapes(world);
  std::vector<BodyPair> pairs;
  SweepAndPrune().find(shapes.spheres, pairs);
  for (const BodyPair& pair : pairs) {
    if (is_kinematic(world, pair.first) && is_kinematic(world, pair.second)) continue;
    const double depth = depth_of_pair(shapes, pair);
    if (depth > deepest.depth) deepest = {pair.first, pair.second, depth};
  }
  return deepest;
}

double max_penetration(const World& world) { return deepest_penetration(world).depth; }

}  // namespace pneuma::sim
