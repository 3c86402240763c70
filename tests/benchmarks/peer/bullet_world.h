// A world of ours as a world of Bullet (btSoftBody, Debian's libbullet): the peer that the paper's
// scenes are run beside.
#pragma once

#include <cstddef>
#include <memory>

#include "sim/world.h"

namespace pneuma::benchmarks {

struct BulletOptions {
  int position_iterations = 1;  // over all links per step; 1 is Bullet's default
  double link_stiffness = 1.0;  // share of a link's error that an iteration takes away, 0..1
};

/// The same meshes, masses, boxes, ground, gravity, gas and drag. What differs is Bullet's
/// own: single precision, links that are constraints (of the full stiffness, its default) between
/// the start positions where ours are springs of k N/m, contact margins of its default instead of
/// our skins, and its defaults of friction and damping.
class BulletWorld {
 public:
  explicit BulletWorld(const sim::World& world, const BulletOptions& options = {});
  ~BulletWorld();
  BulletWorld(BulletWorld&&) noexcept;
  BulletWorld& operator=(BulletWorld&&) noexcept;

  /// One step of the world's length.
  void step();

  /// Contacts that the last step found: of nodes with boxes and ground, of nodes with triangles of
  /// other soft bodies, and of boxes with each other and the ground.
  std::size_t contact_count() const;

  /// Of one soft body, m^3 and m/s.
  double volume(int body) const;
  sim::Vec3 mean_velocity(int body) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pneuma::benchmarks
