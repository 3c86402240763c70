// Bodies that move together: their common motion, which is that of one rigid body with their
// momentum and angular momentum, and what each does besides.
#pragma once

#include <span>

#include "sim/world/world.h"

namespace pneuma::sim {

class GroupMotion {
 public:
  /// `bodies`, which must outlive it: soft bodies by their place in the world, boxes after them.
  GroupMotion(World& world, std::span<const int> bodies) : world_(world), bodies_(bodies) {}

  /// From now on `energy` and `take` are of what is not common.
  void leave_out_common();

  /// J, of motion.
  double energy() const;
  /// Takes so much of it (J), or all that there is, by one factor for all velocities: at contacts
  /// what parts still parts. Returns what was taken, >= 0.
  double take(double energy);
  /// Gives all of them, as one rigid body at its centre of mass, this angular momentum besides
  /// what they have, kg m^2/s. Momentum stays as it is.
  void turn(const Vec3& angular_momentum);

  bool has_soft_bodies() const;
  /// kg.
  double mass() const;

 private:
  void slow(double factor);
  template <class Visit>
  void visit_soft(const Visit& visit) const;
  template <class Visit>
  void visit_vertices(const Visit& visit) const;
  template <class Visit>
  void visit_boxes(const Visit& visit) const;

  struct Mean {
    Vec3 centre = Vec3::Zero();    // m
    Vec3 velocity = Vec3::Zero();  // m/s
  };
  Mean mean() const;
  /// kg m^2, about a centre, in world axes.
  Mat3 inertia(const Vec3& centre) const;
  /// m/s, of the common motion.
  Vec3 common(const Vec3& point) const {
    return velocity_ + angular_velocity_.cross(point - centre_);
  }

  World& world_;
  std::span<const int> bodies_;
  Vec3 centre_ = Vec3::Zero();
  Vec3 velocity_ = Vec3::Zero();
  Vec3 angular_velocity_ = Vec3::Zero();
};

}  // namespace pneuma::sim
