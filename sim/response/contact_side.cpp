#include "sim/response/contact_side.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/rotation.h"
#include "sim/rigid/inertia.h"

namespace pneuma::sim {

BoxMass box_mass(const RigidBox& box) { return {1.0 / box.mass, world_inverse_inertia(box)}; }

SideInContact::SideInContact(World& world, std::span<const BoxMass> masses, const ContactSide& side,
                             const Vec3& point) {
  switch (side.kind) {
    case BodyKind::soft: {
      soft_ = &world.soft[at(side.body)];
      const auto vertices = soft_->mesh->topology.feature_vertices(side.feature);
      vertex_count_ = static_cast<int>(vertices.size());
      std::copy(vertices.begin(), vertices.end(), vertices_.begin());
      inverse_mass_ = 1.0 / (vertex_count_ * soft_->material.vertex_mass);
      break;
    }
    case BodyKind::rigid: {
      box_ = &world.rigid[at(side.body)];
      const BoxMass& mass = masses[at(side.body)];
      inverse_mass_ = mass.inverse_mass;
      inverse_inertia_ = &mass.inverse_inertia;
      arm_ = point - box_->position;
      break;
    }
    case BodyKind::ground:
      break;
  }
}

Vec3 SideInContact::velocity() const {
  if (box_) return box_->velocity + box_->angular_velocity.cross(arm_);
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (int i = 0; i < vertex_count_; ++i) sum += soft_->velocities.rows().col(vertices_[at(i)]);
  return vertex_count_ > 1 ? Vec3(sum.head<3>() / vertex_count_) : Vec3(sum.head<3>());
}

Mat3 SideInContact::mobility() const {
  Mat3 result = inverse_mass_ * Mat3::Identity();
  if (box_) {
    const Mat3 arm = cross_matrix(arm_);
    result -= arm * *inverse_inertia_ * arm;
  }
  return result;
}

void SideInContact::apply(const Vec3& impulse) const {
  const Vec3 change = inverse_mass_ * impulse;
  if (box_) {
    box_->velocity += change;
    box_->angular_velocity += *inverse_inertia_ * arm_.cross(impulse);
    return;
  }
  for (int i = 0; i < vertex_count_; ++i) soft_->velocities[vertices_[at(i)]] += change;
}

Vec3 SideInContact::place() const {
  if (box_) return box_->position;
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < vertex_count_; ++i) sum += soft_->positions[vertices_[at(i)]];
  return vertex_count_ > 1 ? Vec3(sum / vertex_count_) : sum;
}

void SideInContact::displace(const Vec3& displacement) const {
  if (box_) box_->position += displacement;
  for (int i = 0; i < vertex_count_; ++i) soft_->positions[vertices_[at(i)]] += displacement;
}

const Surface& surface(const World& world, const ContactSide& side) {
  switch (side.kind) {
    case BodyKind::soft:
      return world.soft[at(side.body)].material.surface;
    case BodyKind::rigid:
      return world.rigid[at(side.body)].surface;
    case BodyKind::ground:
      break;
  }
  return *world.settings.ground;
}

Surface combine(const Surface& a, const Surface& b) {
  return {std::max(a.restitution, b.restitution), std::sqrt(a.friction * b.friction)};
}

}  // namespace pneuma::sim
