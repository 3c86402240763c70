#include "sim/swept/swept_impulse.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/rotation.h"
#include "sim/rigid/inertia.h"

namespace pneuma::sim {

BoxChange make_box_change(const RigidBox& box, const Vec3& position,
                          const Eigen::Quaterniond& orientation) {
  const Mat3 axes = orientation.toRotationMatrix();
  return {
      .centre = position,
      .inverse_mass = 1.0 / box.mass,
      .inverse_inertia = axes * body_inertia(box).cwiseInverse().asDiagonal() * axes.transpose()};
}

SweptSide::SweptSide(VertexArray& changes, std::span<const int> vertices,
                     const FeatureWeights& weights, double vertex_mass)
    : weights_(weights),
      count_(static_cast<int>(vertices.size())),
      inverse_vertex_mass_(1.0 / vertex_mass) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices_[i] = changes.rows().col(vertices[i]).data();
  }
}

SweptSide::SweptSide(BoxChange& box, const Vec3& point) : box_(&box), arm_(point - box.centre) {}

Vec3 SweptSide::change() const {
  if (box_) return box_->velocity + box_->angular_velocity.cross(arm_);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < at(count_); ++i) {
    sum += weights_[i] * Eigen::Map<const Vec3>(vertices_[i]);
  }
  return sum;
}

void SweptSide::apply(const Vec3& impulse) const {
  if (box_) {
    box_->velocity += box_->inverse_mass * impulse;
    box_->angular_velocity += box_->inverse_inertia * arm_.cross(impulse);
    return;
  }
  for (std::size_t i = 0; i < at(count_); ++i) {
    Eigen::Map<Vec3>(vertices_[i]) += (weights_[i] * inverse_vertex_mass_) * impulse;
  }
}

Mat3 SweptSide::mobility() const {
  if (box_) {
    const Mat3 arm = cross_matrix(arm_);
    return box_->inverse_mass * Mat3::Identity() - arm * box_->inverse_inertia * arm;
  }
  double sum = 0.0;
  for (const double weight : weights_) sum += weight * weight;
  return sum * inverse_vertex_mass_ * Mat3::Identity();
}

SweptImpulse::SweptImpulse(SweptSide first, SweptSide second, const Vec3& normal, double friction)
    : first_(first), second_(second), normal_(normal), friction_(friction) {
  const Mat3 mobility = first_.mobility() + second_.mobility();
  mobility_ = normal_.dot(mobility * normal_);
  normal_mass_ = 1.0 / mobility_;
  tangents_[0] = normal_.unitOrthogonal();
  tangents_[1] = normal_.cross(tangents_[0]);
  Eigen::Matrix<double, 3, 2> across;
  across << tangents_[0], tangents_[1];
  const Eigen::Matrix2d along = across.transpose() * mobility * across;
  tangent_mass_ = along.inverse();
  const double half_difference = 0.5 * (along(0, 0) - along(1, 1));
  min_tangent_mass_ = 1.0 / (0.5 * along.trace() + std::hypot(half_difference, along(0, 1)));
}

void SweptImpulse::aim(double parting, const Vec3& sliding) {
  parting_ = parting;
  sliding_ = sliding - sliding.dot(normal_) * normal_;
}

void SweptImpulse::start_from(double normal, const Vec3& friction) {
  normal_impulse_ = start_normal_ = normal;
  friction_impulse_ = start_friction_ = friction;
}

void SweptImpulse::warm_start(const Vec3& impulse) {
  const double pressing = std::max(0.0, impulse.dot(normal_));
  Vec3 across = impulse - impulse.dot(normal_) * normal_;
  // The normal may have turned since.
  const double limit = friction_ * pressing, size = across.norm();
  if (size > limit) across *= limit / size;
  normal_impulse_ += pressing;
  friction_impulse_ += across;
  apply(pressing * normal_ + across);
}

void SweptImpulse::apply(const Vec3& impulse) const {
  first_.apply(impulse);
  second_.apply(-impulse);
}

double SweptImpulse::correct_normal() {
  const double missing = parting_ - normal_.dot(change());
  const double before = normal_impulse_;
  normal_impulse_ = std::clamp(before + missing * normal_mass_, 0.0, max_normal_);
  const double given = normal_impulse_ - before;
  if (given != 0.0) apply(given * normal_);
  return std::abs(given) * mobility_;
}

// As contact_impulse.cpp: what stops the sliding if the cone allows it, else the nearest point in
// the cone to a step against the sliding, which from within the cone never adds energy.
double SweptImpulse::correct_friction() {
  const double limit = friction_ * normal_impulse_;
  if (limit == 0.0 && friction_impulse_.isZero()) return 0.0;
  const Vec3 slides = change() + sliding_;
  const Eigen::Vector2d along(tangents_[0].dot(slides), tangents_[1].dot(slides));
  const Eigen::Vector2d stop = tangent_mass_ * along;
  Vec3 after = friction_impulse_ - stop[0] * tangents_[0] - stop[1] * tangents_[1];
  if (after.squaredNorm() > limit * limit) {
    after =
        friction_impulse_ - min_tangent_mass_ * (along[0] * tangents_[0] + along[1] * tangents_[1]);
    const double size = after.norm();
    if (size > limit) after *= limit / size;
  }
  const Vec3 given = after - friction_impulse_;
  friction_impulse_ = after;
  apply(given);
  return given.norm() / min_tangent_mass_;
}

double SweptImpulse::correct() {
  const double by_normal = correct_normal();
  return friction_ > 0.0 ? std::max(by_normal, correct_friction()) : by_normal;
}

double SweptImpulse::work(const Vec3& before) const { return given().dot(before + 0.5 * change()); }

void solve(std::span<SweptImpulse> impulses, double tolerance, int max_iterations) {
  for (int i = 0; i < max_iterations; ++i) {
    double largest = 0.0;
    for (SweptImpulse& impulse : impulses) largest = std::max(largest, impulse.correct());
    if (largest <= tolerance) return;
  }
}

}  // namespace pneuma::sim
