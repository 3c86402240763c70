#include "sim/collision/find_body_contacts.h"

#include <algorithm>
#include <limits>

#include "sim/collision/box_contact.h"
#include "sim/collision/point_in_body.h"

namespace pneuma::sim {
namespace {

ContactSide vertex_side(int soft, int vertex) {
  return {SideKind::soft, soft, {FeatureKind::vertex, vertex}};
}

ContactSide box_side(int rigid) { return {SideKind::rigid, rigid, {}}; }

/// m by which what is inside is to be moved out.
double depth_of(const Settings& settings, double depth) {
  return is_as_printed(settings) ? settings.skin_thickness : depth;
}

/// Vertices of the soft body inside the box, in ascending order.
void find_vertices_in_box(const World& world, const PlacedBox& placed, int soft, int rigid,
                          const VertexColumns& columns, std::vector<Contact>& contacts) {
  const VertexArray& positions = world.soft[at(soft)].positions;
  const double squared_radius = placed.box.half.squaredNorm();
  const auto found = std::ssize(contacts);
  columns.for_each_near(placed.bounds, [&](int v) {
    const Vec3 vertex = positions[v];
    if ((vertex - placed.box.centre).squaredNorm() > squared_radius) return;
    if (const auto exit = find_box_exit(placed.box, vertex)) {
      contacts.push_back({vertex_side(soft, v), box_side(rigid), vertex, exit->normal,
                          depth_of(world.settings, exit->depth)});
    }
  });
  std::sort(contacts.begin() + found, contacts.end(), [](const Contact& a, const Contact& b) {
    return a.first.feature.index < b.first.feature.index;
  });
}

void find_corners_in_surface(const World& world, const PlacedBox& placed, int soft, int rigid,
                             const TriangleColumns& columns, std::vector<Contact>& contacts) {
  const SoftBody& body = world.soft[at(soft)];
  const SurfaceView surface{body.mesh->topology, body.positions};
  for (const Vec3& corner : corners(placed.box)) {
    if (const auto exit = find_surface_exit(surface, columns, corner)) {
      contacts.push_back({box_side(rigid),
                          {SideKind::soft, soft, {FeatureKind::triangle, exit->triangle}},
                          corner,
                          exit->normal,
                          depth_of(world.settings, exit->depth)});
    }
  }
}

}  // namespace

PlacedBox placed_box(const RigidBox& box) {
  const OrientedBox oriented{box.position, box.orientation.toRotationMatrix(), 0.5 * box.size};
  return {oriented, bounds(oriented)};
}

RestingLengths resting_lengths(double shortest_side) {
  const double margin = std::min(0.005, 0.05 * shortest_side);
  return {margin, 0.5 * margin};
}

void find_soft_ground(const World& world, int soft, std::vector<Contact>& contacts) {
  const VertexArray& positions = world.soft[at(soft)].positions;
  const Pins* pins = world.soft[at(soft)].pins.get();
  // The implicit integrators keep vertices above the ground: what rests on it is at z = 0 exactly.
  const bool rests_at_zero = is_implicit(world.settings.integrator);
  const double above = rests_at_zero ? std::numeric_limits<double>::denorm_min() : 0.0;
  const double* const heights = positions.rows().data() + 2;
  const int count = positions.size();
  for (int v = 0; v < count; ++v) {
    const double height = heights[row_start(v)];
    if (!(height < above) || (pins && pins->is_pinned[at(v)] != 0)) continue;
    contacts.push_back({vertex_side(soft, v), {}, positions[v], Vec3::UnitZ(), -height});
  }
}

void find_rigid_ground(std::span<const PlacedBox> boxes, int rigid,
                       std::vector<Contact>& contacts) {
  const auto& [box, bounds] = boxes[at(rigid)];
  const RestingLengths resting = resting_lengths(2.0 * box.half.minCoeff());
  if (bounds.low.z() > 2.0 * resting.margin) return;  // no corner is as near, whatever the rounding
  for (const Vec3& corner : corners(box)) {
    if (!(corner.z() < resting.margin)) continue;
    contacts.push_back({box_side(rigid),
                        {},
                        corner,
                        Vec3::UnitZ(),
                        -corner.z() - resting.overlap,
                        std::max(0.0, corner.z())});
  }
}

void find_soft_rigid(const World& world, std::span<const PlacedBox> boxes, int soft, int rigid,
                     const SurfaceColumns& columns, std::vector<Contact>& contacts) {
  const PlacedBox& placed = boxes[at(rigid)];
  find_vertices_in_box(world, placed, soft, rigid, columns.vertices, contacts);
  find_corners_in_surface(world, placed, soft, rigid, columns.triangles, contacts);
}

void find_rigid_rigid(std::span<const PlacedBox> boxes, int first, int second,
                      std::vector<Contact>& contacts) {
  OrientedBox a = boxes[at(first)].box;
  OrientedBox b = boxes[at(second)].box;
  const RestingLengths resting =
      resting_lengths(2.0 * std::min(a.half.minCoeff(), b.half.minCoeff()));
  const double growth = 0.5 * resting.margin;  // of each box on all sides
  a.half.array() += growth;
  b.half.array() += growth;
  const auto contact = find_box_contact(a, b);
  if (!contact) return;
  // A corner or an edge has come nearer by more than a face.
  const double grown_along_normal = growth * ((a.axes.transpose() * contact->normal).lpNorm<1>() +
                                              (b.axes.transpose() * contact->normal).lpNorm<1>());
  for (const BoxContactPoint& point : contact->points()) {
    const double depth = point.depth - grown_along_normal;
    if (depth < -resting.margin) continue;
    contacts.push_back({box_side(first), box_side(second), point.point, contact->normal,
                        depth - resting.overlap, std::max(0.0, -depth)});
  }
}

void find_printed_rigid_ground(std::span<const PlacedBox> boxes, int rigid,
                               std::vector<Contact>& contacts) {
  Vec3 sum = Vec3::Zero();
  double lowest = 0.0;
  int below = 0;
  for (const Vec3& corner : corners(boxes[at(rigid)].box)) {
    if (!(corner.z() < 0.0)) continue;
    sum += corner;
    lowest = std::min(lowest, corner.z());
    ++below;
  }
  if (below > 0) contacts.push_back({box_side(rigid), {}, sum / below, Vec3::UnitZ(), -lowest});
}

void find_printed_rigid_rigid(std::span<const PlacedBox> boxes, int first, int second,
                              std::vector<Contact>& contacts) {
  const auto contact = find_box_contact(boxes[at(first)].box, boxes[at(second)].box);
  if (!contact) return;
  Vec3 sum = Vec3::Zero();
  for (const BoxContactPoint& point : contact->points()) sum += point.point;
  contacts.push_back(
      {box_side(first), box_side(second), sum / contact->count, contact->normal, contact->depth});
}

}  // namespace pneuma::sim
