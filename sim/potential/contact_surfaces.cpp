#include "sim/potential/contact_surfaces.h"

#include <algorithm>
#include <map>

#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/potential/box_frame.h"
#include "sim/potential/near_pairs.h"
#include "sim/potential/pair_distance.h"
#include "sim/soft/gas_law.h"

namespace pneuma::sim {
namespace {

/// At most, of the mean edge: far less than what a surface can be bent by.
constexpr double reach_of_edge = 0.05;
/// Of how near features of one surface are at rest, which must not push each other there.
constexpr double reach_of_rest_distance = 0.5;

constexpr double typical_speed = 5.0;  // m/s
/// Part of a body's surface that carries its weight.
constexpr double carrying_fraction = 0.1;
/// Of the barrier's stiffness over a pressure that it carries at three quarters of its reach.
constexpr double stiffness_over_pressure = 5.0;

}  // namespace

ContactSurfaces::ContactSurfaces(const World& world)
    : soft_count_(static_cast<int>(world.soft.size())),
      speed_(world.settings.potential.regularisation_speed),
      ground_(world.settings.ground) {
  const double distance = world.settings.potential.distance;
  std::map<const SoftMesh*, std::shared_ptr<const SurfaceTree>> trees;
  for (const SoftBody& body : world.soft) {
    add(body.mesh->topology, body.mesh->rest_positions, false, body.material.surface, distance);
    std::shared_ptr<const SurfaceTree>& tree = trees[body.mesh.get()];
    if (!tree) tree = surfaces_.back().tree;
    surfaces_.back().tree = tree;
    for (int v = 0; v < body.positions.size(); ++v) {
      const bool pinned = body.pins && body.pins->is_pinned[at(v)] != 0;
      is_mobile_.push_back(pinned ? 0 : 1);
      surfaces_.back().is_mobile |= !pinned;
    }
  }
  for (const RigidBox& box : world.rigid) {
    add_box(box, distance);
  }
  find_self_reaches();
  const std::optional<double>& given = world.settings.potential.stiffness;
  stiffness_ = given ? *given : default_stiffness(world, surfaces_);
}

int ContactSurfaces::surface_of(int vertex) const {
  int s = 0;
  while (s + 1 < count() && surfaces_[at(s + 1)].first_vertex <= vertex) ++s;
  return s;
}

void ContactSurfaces::add(const MeshTopology& topology, const VertexArray& rest, bool is_rigid,
                          const ContactMaterial& material, double distance) {
  ContactSurface surface;
  surface.first_vertex = static_cast<int>(is_mobile_.size());
  surface.vertex_count = topology.vertex_count();
  surface.tree = std::make_shared<SurfaceTree>(topology, rest, is_rigid);
  surface.reach = std::min(distance, reach_of_edge * surface.tree->mean_edge());
  surface.is_rigid = is_rigid;
  surface.material = material;
  surface.areas.assign(at(topology.vertex_count()), 0.0);
  for (const Triangle& t : topology.triangles()) {
    const double area = area_vector(rest[t[0]], rest[t[1]], rest[t[2]]).norm();
    surface.triangle_areas.push_back(area);
    surface.area += area;
    for (const int v : t) surface.areas[at(v)] += area / 3.0;
  }
  for (const auto& [a, b] : topology.edges()) {
    surface.edge_lengths.push_back((rest[a] - rest[b]).norm());
  }
  surfaces_.push_back(std::move(surface));
  rest_.push_back(rest);
}

void ContactSurfaces::add_box(const RigidBox& box, double distance) {
  const TriangleMesh mesh = make_box(box.size, 1);
  corners_.push_back(to_vertex_array(mesh.vertices));
  box_topologies_.push_back(
      std::make_unique<const MeshTopology>(static_cast<int>(mesh.vertices.size()), mesh.triangles));
  add(*box_topologies_.back(), corners_.back(), true, box.surface, distance);
  // Its diagonals are those of faces that are drawn: corners differ in the triangles they have.
  ContactSurface& surface = surfaces_.back();
  surface.areas.assign(surface.areas.size(), surface.area / static_cast<double>(box_corners));
  is_mobile_.resize(is_mobile_.size() + mesh.vertices.size(), box.is_kinematic ? 0 : 1);
  surface.is_mobile = !box.is_kinematic;
}

/// Features of one surface that are near each other at rest do not push each other there.
void ContactSurfaces::find_self_reaches() {
  std::map<const SurfaceTree*, double> known;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    ContactSurface& surface = surfaces_[i];
    if (!surface.is_mobile || surface.is_rigid) continue;
    const auto [entry, is_new] = known.try_emplace(surface.tree.get(), surface.reach);
    if (is_new) {
      const double least =
          min_self_distance(surface, rest_[i], surface.reach / reach_of_rest_distance);
      entry->second = std::min(surface.reach, reach_of_rest_distance * least);
    }
    surface.self_reach = std::min(surface.reach, entry->second);
  }
}

void ContactSurfaces::place_box(const Pose& pose, int i, VertexArray& positions) const {
  const VertexArray& own = corners_[at(i)];
  const int first = of_box(i).first_vertex;
  const Mat3 axes = pose.orientation.toRotationMatrix();
  for (int v = 0; v < own.size(); ++v) positions[first + v] = pose.position + axes * Vec3(own[v]);
}

void ContactSurfaces::place_boxes(const World& world, VertexArray& positions) const {
  for (int i = 0; i < static_cast<int>(world.rigid.size()); ++i) {
    const RigidBox& box = world.rigid[at(i)];
    place_box({box.position, box.orientation}, i, positions);
  }
}

void ContactSurfaces::gather(const World& world, VertexArray& positions,
                             VertexArray& velocities) const {
  for (std::size_t b = 0; b < world.soft.size(); ++b) {
    const SoftBody& body = world.soft[b];
    const int first = surfaces_[b].first_vertex, count = surfaces_[b].vertex_count;
    positions.rows().middleCols(first, count) = body.positions.rows();
    velocities.rows().middleCols(first, count) = body.velocities.rows();
  }
}

double default_stiffness(const World& world, const std::vector<ContactSurface>& surfaces) {
  double pressure = 1.0;
  const double gravity = world.settings.gravity.norm();
  // Of a surface of some mass per area, kg/m^2.
  const auto meet_mass = [&](double density, double reach) {
    const double weight = density * gravity / carrying_fraction;
    const double impact = density * typical_speed * typical_speed / reach;
    pressure = std::max({pressure, weight, impact});
  };
  for (std::size_t b = 0; b < world.soft.size(); ++b) {
    const SoftBody& body = world.soft[b];
    const ContactSurface& surface = surfaces[b];
    if (!surface.is_mobile) continue;
    const double enclosed = volume(body.mesh->topology, body.mesh->rest_positions);
    const double gas = enclosed > 0.0 ? gas_strength(body.material) / enclosed : 0.0;
    const double springs = body.material.k / surface.tree->mean_edge();
    meet_mass(body.material.vertex_mass * surface.vertex_count / surface.area, surface.reach);
    pressure = std::max({pressure, gas, springs});
  }
  for (std::size_t i = 0; i < world.rigid.size(); ++i) {
    const ContactSurface& surface = surfaces[world.soft.size() + i];
    if (surface.is_mobile) meet_mass(world.rigid[i].mass / surface.area, surface.reach);
  }
  return stiffness_over_pressure * pressure;
}

}  // namespace pneuma::sim
