// A world of ours as a world of Bullet (btSoftBody, Debian's libbullet): the peer that the paper's
// scenes are run beside.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "sim/world/world.h"

namespace pneuma::benchmarks {

enum class BulletGround {
  box,    // of 1 km whose top is z = 0, as in Bullet's own demos
  plane,  // which Bullet takes for a concave shape: it looks at its triangles
};

struct BulletOptions {
  int position_iterations = 1;  // over all links per substep; 1 is Bullet's default
  int substeps = 1;             // of equal length, per step of the world
  double link_stiffness = 1.0;  // fraction of a link's error that an iteration takes away, 0..1
  double gas_fraction = 1.0;    // of the gas in our body, > 0
  double margin = 0.25;         // m around a soft body in which it has contacts; Bullet's default
  // m: Bullet keeps the distance to boxes and ground on a sparse grid of such voxels. 0.25 is its
  // default, which bodies of several metres wander through faster than it pays.
  double voxel_size = 1.0;
  BulletGround ground = BulletGround::box;
  double drag =
      0.0;  // fraction of the velocity lost per 1/60 s, besides the scene's, 0 <= drag < 1

  friend bool operator==(const BulletOptions&, const BulletOptions&) = default;
};

/// The same meshes, masses, boxes, ground, gravity, friction and drag, and as much of the gas as
/// the options say. What differs is Bullet's own: single precision, links that are constraints
/// between the start positions where ours are springs of k N/m, gas that pushes each node along the
/// mean of its triangles' normals and with their areas at the start, and its defaults of
/// restitution and damping.
class BulletWorld {
 public:
  explicit BulletWorld(const sim::World& world, const BulletOptions& options = {});
  ~BulletWorld();
  BulletWorld(BulletWorld&&) noexcept;
  BulletWorld& operator=(BulletWorld&&) noexcept;

  /// One step of the world's length, in substeps.
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

/// The Bullet library that is loaded, and what it was compiled with.
std::string bullet_build();

}  // namespace pneuma::benchmarks
