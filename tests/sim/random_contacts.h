// Random contacts, and section 5.3 written out once more to check their impulses.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "sim/response/contact_impulse.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {

/// Random contacts between two soft bodies, two boxes and the ground: every pair of side kinds in
/// turn, whatever lies where, because an impulse is to be right for any point and normal.
class RandomContacts {
 public:
  explicit RandomContacts(std::uint64_t seed) : random_(seed) {
    world_.settings.gravity.setZero();
    for (int i = 0; i < 2; ++i) world_.soft.push_back(make_body(make_box({1.0, 1.0, 1.0}, 1)));
    world_.rigid.resize(2);
  }

  World& world() { return world_; }
  const Contact& contact() const { return contact_; }
  const std::vector<BoxMass>& masses() const { return masses_; }
  double uniform(double low, double high) { return low + (high - low) * unit_(random_); }

  void next() {
    for (SoftBody& body : world_.soft) renew(body);
    masses_.clear();
    for (RigidBox& box : world_.rigid) {
      renew(box);
      masses_.push_back(box_mass(box));
    }
    world_.settings.ground = surface();
    contact_ = {};
    contact_.normal = direction();
    contact_.point = vector(2.0);
    choose_sides();
  }

 private:
  double magnitude(double least, double most) {
    return std::exp(uniform(std::log(least), std::log(most)));
  }
  Vec3 vector(double most) {
    return {uniform(-most, most), uniform(-most, most), uniform(-most, most)};
  }
  Vec3 direction() {
    while (true) {
      const Vec3 v = vector(1.0);
      if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
    }
  }
  ContactMaterial surface() { return {uniform(0.0, 1.0), uniform(0.0, 2.0)}; }

  void renew(SoftBody& body) {
    body.material.vertex_mass = magnitude(1e-3, 1e3);
    body.material.surface = surface();
    for (int v = 0; v < body.positions.size(); ++v) {
      body.positions[v] = vector(2.0);
      body.velocities[v] = vector(10.0);
    }
  }
  void renew(RigidBox& box) {
    box.mass = magnitude(1e-3, 1e3);
    box.size = {magnitude(0.2, 5.0), magnitude(0.2, 5.0), magnitude(0.2, 5.0)};
    box.position = vector(2.0);
    const double angle = uniform(0.0, 6.0);
    box.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, direction()));
    box.velocity = vector(10.0);
    box.angular_velocity = vector(10.0);
    box.surface = surface();
  }

  ContactSide soft_side(int body, int kind) {
    const int count[] = {8, 18, 12};  // of a box of twelve triangles
    const int index = static_cast<int>(uniform(0.0, count[kind]));
    return {SideKind::soft, body, {static_cast<FeatureKind>(kind), index}};
  }

  /// Soft first: 3 kinds against 3 soft kinds, the box, the ground. Box first: against 3 soft
  /// kinds, the box, the ground.
  void choose_sides() {
    const int first = turn_ % 4, second = turn_ / 4 % 5;
    ++turn_;
    contact_.first = first < 3 ? soft_side(0, first) : ContactSide{SideKind::rigid, 0, {}};
    if (second < 3) contact_.second = soft_side(1, second);
    if (second == 3) contact_.second = {SideKind::rigid, 1, {}};
  }

  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_;
  World world_;
  Contact contact_;
  std::vector<BoxMass> masses_;
  int turn_ = 0;
};

/// What section 5.3's equation needs of one side, written out from the paper.
struct Side {
  double inverse_mass = 0.0;
  Mat3 inverse_inertia = Mat3::Zero();
  Vec3 arm = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
};

inline Side look_at(const World& world, const ContactSide& side, const Vec3& point) {
  Side result;
  if (side.kind == SideKind::soft) {
    const SoftBody& body = world.soft[at(side.body)];
    double mass = 0.0;
    Vec3 momentum = Vec3::Zero();
    for (const int v : body.mesh->topology.feature_vertices(side.feature)) {
      mass += body.material.vertex_mass;
      momentum += body.material.vertex_mass * body.velocities[v];
    }
    result.inverse_mass = 1.0 / mass;
    result.velocity = momentum / mass;
  }
  if (side.kind == SideKind::rigid) {
    const RigidBox& box = world.rigid[at(side.body)];
    const Mat3 rotation = box.orientation.toRotationMatrix();
    const double w = box.size.x(), h = box.size.y(), d = box.size.z();
    const Vec3 inertia = box.mass / 12.0 * Vec3(h * h + d * d, w * w + d * d, w * w + h * h);
    result.inverse_mass = 1.0 / box.mass;
    result.inverse_inertia = rotation * inertia.cwiseInverse().asDiagonal() * rotation.transpose();
    result.arm = point - box.position;
    result.velocity = box.velocity + box.angular_velocity.cross(result.arm);
  }
  return result;
}

struct Sides {
  Side first, second;

  explicit Sides(const World& world, const Contact& contact)
      : first(look_at(world, contact.first, contact.point)),
        second(look_at(world, contact.second, contact.point)) {}

  Vec3 relative_velocity() const { return first.velocity - second.velocity; }

  /// The denominator of the paper's j.
  double inverse_mass(const Vec3& n) const {
    const Vec3 turning = (first.inverse_inertia * first.arm.cross(n)).cross(first.arm) +
                         (second.inverse_inertia * second.arm.cross(n)).cross(second.arm);
    return first.inverse_mass + second.inverse_mass + n.dot(turning);
  }
};

/// The surface of a pair (sim/world/world.h).
inline ContactMaterial pair_surface(const World& world, const Contact& contact) {
  const auto of = [&world](const ContactSide& side) {
    if (side.kind == SideKind::soft) return world.soft[at(side.body)].material.surface;
    if (side.kind == SideKind::rigid) return world.rigid[at(side.body)].surface;
    return *world.settings.ground;
  };
  const ContactMaterial a = of(contact.first), b = of(contact.second);
  return {std::max(a.restitution, b.restitution), std::sqrt(a.friction * b.friction)};
}

inline bool has_box(const Contact& contact) {
  return contact.first.kind == SideKind::rigid || contact.second.kind == SideKind::rigid;
}

/// What a step does with a contact: stops the sides, then lets them bounce.
inline void resolve(ContactImpulse& impulse, int corrections = 1) {
  for (int i = 0; i < corrections; ++i) impulse.correct();
  if (!impulse.bounce()) return;
  for (int i = 0; i < corrections; ++i) impulse.correct();
}

}  // namespace pneuma::sim
