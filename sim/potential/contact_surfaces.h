// What takes part in the contact potential: the surfaces of all bodies of a world, with their
// vertices in one array, and what about them does not change.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sim/mesh/topology.h"
#include "sim/rigid/given_motion.h"
#include "sim/swept/surface_tree.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Of a soft body, an obstacle, or a box.
struct ContactSurface {
  int first_vertex = 0;  // in the array of all surfaces
  int vertex_count = 0;
  std::shared_ptr<const SurfaceTree> tree;
  bool is_mobile = false;   // some vertex is moved by forces
  bool is_rigid = false;    // its vertices move together: it never meets itself
  double reach = 0.0;       // m: the potential is zero beyond it
  double self_reach = 0.0;  // m, between its own features
  double area = 0.0;        // m^2 at rest
  ContactMaterial material;
  std::vector<double> areas;           // m^2 at rest, per vertex: a third of its triangles'
  std::vector<double> triangle_areas;  // m^2 at rest
  std::vector<double> edge_lengths;    // m at rest

  const MeshTopology& topology() const { return tree->topology(); }
};

/// The order is that of body indices: soft bodies, then boxes.
class ContactSurfaces {
 public:
  explicit ContactSurfaces(const World& world);

  const std::vector<ContactSurface>& all() const { return surfaces_; }
  const ContactSurface& operator[](int i) const { return surfaces_[at(i)]; }
  /// Of a box of the world.
  const ContactSurface& of_box(int i) const { return surfaces_[at(soft_count_ + i)]; }
  int count() const { return static_cast<int>(surfaces_.size()); }
  int surface_of(int vertex) const;
  int vertex_count() const { return static_cast<int>(is_mobile_.size()); }
  bool is_mobile(int vertex) const { return is_mobile_[at(vertex)] != 0; }
  const std::vector<std::uint8_t>& mobile() const { return is_mobile_; }

  /// Pa, of the barrier.
  double stiffness() const { return stiffness_; }
  /// m/s, at which friction and restitution act in full.
  double regularisation_speed() const { return speed_; }
  const std::optional<ContactMaterial>& ground() const { return ground_; }

  /// The corners of box `i` of the world into the array of all vertices.
  void place_box(const Pose& pose, int i, VertexArray& positions) const;
  void place_boxes(const World& world, VertexArray& positions) const;
  /// Positions, then velocities, of all soft bodies.
  void gather(const World& world, VertexArray& positions, VertexArray& velocities) const;

 private:
  void add(const MeshTopology& topology, const VertexArray& rest, bool is_rigid,
           const ContactMaterial& material, double distance);
  void add_box(const RigidBox& box, double distance);
  void find_self_reaches();

  std::vector<ContactSurface> surfaces_;
  std::vector<std::uint8_t> is_mobile_;
  std::vector<std::unique_ptr<const MeshTopology>> box_topologies_;
  std::vector<VertexArray> corners_;  // of boxes, about their centres
  std::vector<VertexArray> rest_;     // per surface
  int soft_count_ = 0;
  double stiffness_ = 0.0;
  double speed_ = 0.0;
  std::optional<ContactMaterial> ground_;
};

/// Pa: what holds the bodies of a world apart at a good part of their reach, from what is known of
/// them before they move: their gas, springs, weight, and a speed of 5 m/s.
double default_stiffness(const World& world, const std::vector<ContactSurface>& surfaces);

}  // namespace pneuma::sim
