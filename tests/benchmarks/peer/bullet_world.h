// A world of ours as a world of Bullet (btSoftBody, Debian's libbullet): the peer that the paper's
// scenes are run beside.
#pragma once

#include <cstddef>
#include <memory>

#include "sim/world/world.h"

namespace pneuma::benchmarks {

struct BulletOptions {
  int position_iterations = 1;  // over all links per step; 1 is Bullet's default
  double link_stiffness = 1.0;  // fraction of a link's error that an iteration takes away, 0..1
  double gas_fraction = 1.0;    // of the gas in our body
};

/// With these a sphere of Bullet's comes to rest on the ground. Bullet pushes each node with the
/// areas of its triangles along the mean of their normals; over a surface that is not quite
/// symmetric these forces do not sum to zero, and with all of the gas they drive the sphere over
/// the ground. Chosen by hand; what else was tried is in tests/benchmarks/README.md.
inline constexpr BulletOptions at_rest{.position_iterations = 2, .gas_fraction = 0.05};

/// The same meshes, masses, boxes, ground, gravity, friction and drag, and as much of the gas as
/// the options say. What differs is Bullet's own: single precision, links that are constraints (of
/// the full stiffness, its default) between the start positions where ours are springs of k N/m,
/// contact margins of its default instead of our skins, and its defaults of restitution and
/// damping.
class BulletWorld {
 public:
  explicit BulletWorld(const sim::World& world, const BulletOptions& options = {});
  ~BulletWorld();
  BulletWorld(BulletWorld&&) noexcept;
  BulletWorld& operator=(BulletWorld&&) noexcept;

  /// One step of the world's length.
  void step();

  /// Of a world with the same bodies: where they are now, and their velocities.
  void copy_state(sim::World& world) const;

  /// Contacts that the last step found: of nodes with boxes and ground, of nodes with triangles of
  /// other soft bodies, and of boxes with each other and the ground.
  std::size_t contact_count() const;

  /// Of one soft body, m^3 and m/s.
  double volume(int body) const;
  sim::Vec3 mean_velocity(int body) const;

  /// Of the grid on which the distance to boxes and ground is kept, m.
  double voxel_size() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pneuma::benchmarks
