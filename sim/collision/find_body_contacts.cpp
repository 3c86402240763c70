#include "sim/collision/find_body_contacts.h"

#include <algorithm>

#include "sim/collision/box_contact.h"
#include "sim/collision/point_in_body.h"

namespace pneuma::sim {
namespace {

/// m. Points of boxes this near are contacts already, so that boxes at rest do not lose each other
/// to rounding; impulses let them close the gap.
constexpr double resting_gap = 0.005;

/// m. Boxes are left this far in each other: pushing the deepest point out altogether would lift
/// the other points off, and boxes at rest would rattle.
constexpr double resting_overlap = 0.0025;

OrientedBox oriented_box(const RigidBox& box) {
  return {box.position, box.orientation.toRotationMatrix(), 0.5 * box.size};
}

ContactSide vertex_side(int soft, int vertex) {
  return {BodyKind::soft, soft, {FeatureKind::vertex, vertex}};
}

ContactSide box_side(int rigid) { return {BodyKind::rigid, rigid, {}}; }

}  // namespace

void find_soft_ground(const World& world, int soft, std::vector<Contact>& contacts) {
  const VertexArray& positions = world.soft[at(soft)].positions;
  for (int v = 0; v < positions.size(); ++v) {
    const double height = positions[v].z();
    if (!(height < 0.0)) continue;
    contacts.push_back({vertex_side(soft, v), {}, positions[v], Vec3::UnitZ(), -height});
  }
}

void find_rigid_ground(const World& world, int rigid, std::vector<Contact>& contacts) {
  const OrientedBox box = oriented_box(world.rigid[at(rigid)]);
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = box.corner(i);
    if (!(corner.z() < resting_gap)) continue;
    contacts.push_back({box_side(rigid),
                        {},
                        corner,
                        Vec3::UnitZ(),
                        -corner.z() - resting_overlap,
                        std::max(0.0, corner.z())});
  }
}

void find_soft_rigid(const World& world, int soft, int rigid, std::vector<Contact>& contacts) {
  const SoftBody& body = world.soft[at(soft)];
  const OrientedBox box = oriented_box(world.rigid[at(rigid)]);
  const double squared_radius = box.half.squaredNorm();
  for (int v = 0; v < body.positions.size(); ++v) {
    const Vec3 vertex = body.positions[v];
    if ((vertex - box.centre).squaredNorm() > squared_radius) continue;
    if (const auto exit = find_box_exit(box, vertex)) {
      contacts.push_back(
          {vertex_side(soft, v), box_side(rigid), vertex, exit->normal, exit->depth});
    }
  }
  const SurfaceView surface{body.mesh->topology, body.positions};
  const Bounds surface_bounds = bounds(body.positions);
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = box.corner(i);
    if (const auto exit = find_surface_exit(surface, surface_bounds, corner)) {
      contacts.push_back({box_side(rigid),
                          {BodyKind::soft, soft, {FeatureKind::triangle, exit->triangle}},
                          corner,
                          exit->normal,
                          exit->depth});
    }
  }
}

void find_rigid_rigid(const World& world, int first, int second, std::vector<Contact>& contacts) {
  const auto grown = [&](int rigid) {
    OrientedBox box = oriented_box(world.rigid[at(rigid)]);
    box.half.array() += 0.5 * resting_gap;
    return box;
  };
  const auto contact = find_box_contact(grown(first), grown(second));
  if (!contact) return;
  for (const BoxContactPoint& point : contact->points()) {
    const double depth = point.depth - resting_gap;
    contacts.push_back({box_side(first), box_side(second), point.point, contact->normal,
                        depth - resting_overlap, std::max(0.0, -depth)});
  }
}

}  // namespace pneuma::sim
