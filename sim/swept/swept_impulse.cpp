#include "sim/swept/swept_impulse.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/rotation.h"
#include "sim/rigid/inertia.h"

namespace pneuma::sim {
namespace {

/// The vector, or the longest along it that is no longer than `limit`.
Vec4d within(double limit, Vec4d vector) {
  const double size = std::sqrt(dot(vector, vector));
  return size > limit ? limit / size * vector : vector;
}

}  // namespace

BoxChange make_box_change(const RigidBox& box, const Vec3& position,
                          const Eigen::Quaterniond& orientation) {
  return {.centre = to_vec4d(position),
          .inverse_mass = 1.0 / box.mass,
          .inverse_inertia = mat3x4(world_inverse_inertia(box, orientation))};
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

SweptSide::SweptSide(BoxChange& box, const Vec3& point)
    : box_(&box), arm_(to_vec4d(point) - box.centre) {}

Vec4d SweptSide::change_of_vertices() const {
  Vec4d sum{};
  for (std::size_t i = 0; i < at(count_); ++i) {
    sum = fma(weights_[i], load_vec4d(vertices_[i]), sum);
  }
  return sum;
}

void SweptSide::apply_to_vertices(Vec4d impulse) const {
  const Vec4d change = inverse_vertex_mass_ * impulse;
  for (std::size_t i = 0; i < at(count_); ++i) {
    store_vec4d(fma(weights_[i], change, load_vec4d(vertices_[i])), vertices_[i]);
  }
}

double SweptSide::mobility(Vec4d axis, Vec4d other) const {
  const double across = dot(axis, other);
  if (box_) {
    const Vec4d turn = box_->inverse_inertia * cross(arm_, other);
    return box_->inverse_mass * across + dot(cross(arm_, axis), turn);
  }
  double sum = 0.0;
  for (const double weight : weights_) sum += weight * weight;
  return sum * inverse_vertex_mass_ * across;
}

SweptImpulse::SweptImpulse(SweptSide first, SweptSide second, const Vec3& normal, double friction)
    : first_(first), second_(second), normal_(to_vec4d(normal)), friction_(friction) {
  tangent_ = to_vec4d(normal.unitOrthogonal());
  const Vec4d other = cross(normal_, tangent_);
  const auto mobility = [&](Vec4d a, Vec4d b) {
    return first_.mobility(a, b) + second_.mobility(a, b);
  };
  mobility_ = mobility(normal_, normal_);
  normal_mass_ = 1.0 / mobility_;
  const double one = mobility(tangent_, tangent_), both = mobility(tangent_, other);
  const double another = mobility(other, other), half_difference = 0.5 * (one - another);
  const double radius = std::sqrt(half_difference * half_difference + both * both);
  min_tangent_mass_ = 1.0 / (0.5 * (one + another) + radius);
}

void SweptImpulse::aim(double parting, const Vec3& sliding) {
  parting_ = parting;
  sliding_ = to_vec4d(sliding);
  sliding_ -= dot(sliding_, normal_) * normal_;
}

void SweptImpulse::start_from(double normal, const Vec3& friction) {
  normal_impulse_ = start_normal_ = normal;
  // The normal may have turned since: of that part nothing is taken back.
  const Vec4d across = to_vec4d(friction);
  friction_impulse_ = start_friction_ = across - dot(across, normal_) * normal_;
}

void SweptImpulse::count_from(double normal, const Vec3& friction) {
  normal_impulse_ -= normal;
  start_normal_ -= normal;
  max_normal_ -= normal;
  friction_impulse_ -= to_vec4d(friction);
  start_friction_ -= to_vec4d(friction);
}

void SweptImpulse::warm_start(const Vec3& impulse) {
  const Vec4d whole = to_vec4d(impulse);
  const double along = dot(whole, normal_), pressing = std::max(0.0, along);
  // The normal may have turned since.
  const Vec4d across =
      within(friction_ * (pressing + squeeze_ + pressed_), whole - along * normal_);
  normal_impulse_ += pressing;
  friction_impulse_ += across;
  apply(pressing * normal_ + across);
}

/// lambda = clamp(lambda_0 + k (wanted - n.u)).
void SweptImpulse::respond_along_normal(Vec4d change, double penalty, Response& response) const {
  const double stiffness = penalty * normal_mass_;
  const double missing = parting_ - dot(normal_, change);
  const double tried = normal_impulse_ + stiffness * missing;
  const double normal = std::clamp(tried, 0.0, max_normal_);
  response.given += normal * normal_;
  if (normal != tried) return;
  const Vec3 n = to_vec3(normal_);
  response.stiffness += stiffness * n * n.transpose();
}

/// Likewise across the normal, within the disc that the normal impulse allows as it is.
void SweptImpulse::respond_with_friction(Vec4d change, double penalty, Response& response) const {
  const double limit = friction_ * pressing();
  if (limit == 0.0) return;
  const double stiffness = penalty * min_tangent_mass_;
  Vec4d slides = change + sliding_;
  slides -= dot(slides, normal_) * normal_;
  const Vec4d tried = friction_impulse_ - stiffness * slides;
  response.given += within(limit, tried);
  const Vec3 n = to_vec3(normal_);
  Mat3 grows = Mat3::Identity() - n * n.transpose();
  const double size = std::sqrt(dot(tried, tried));
  if (size > limit) {
    const Vec3 along = to_vec3(tried) / size;
    grows = limit / size * (grows - along * along.transpose());
  }
  response.stiffness += stiffness * grows;
}

SweptImpulse::Response SweptImpulse::respond(Vec4d change, double penalty) const {
  Response response;
  respond_along_normal(change, penalty, response);
  respond_with_friction(change, penalty, response);
  response.given -= start();
  return response;
}

void SweptImpulse::replace_given(Vec4d given) {
  const Vec4d all = given + start();
  const double along = dot(all, normal_), normal = std::max(0.0, along);
  const Vec4d friction = all - along * normal_;
  apply((normal - normal_impulse_) * normal_ + (friction - friction_impulse_));
  normal_impulse_ = normal;
  friction_impulse_ = friction;
}

void SweptImpulse::exceed_beside_boxes(Vec4d impulse) {
  const double along = dot(impulse, normal_);
  normal_impulse_ += along;
  friction_impulse_ += impulse - along * normal_;
  first_.apply_beside_boxes(impulse);
  second_.apply_beside_boxes(-impulse);
}

void SweptImpulse::apply(Vec4d impulse) const {
  first_.apply(impulse);
  second_.apply(-impulse);
}

double SweptImpulse::raise_normal(double change) {
  const double before = normal_impulse_;
  normal_impulse_ = std::clamp(before + (parting_ - change) * normal_mass_, 0.0, max_normal_);
  return normal_impulse_ - before;
}

bool SweptImpulse::may_rub() const {
  return friction_ * pressing() != 0.0 || dot(friction_impulse_, friction_impulse_) != 0.0;
}

// A step against the sliding, then the nearest point in the cone: from within the cone it never
// adds energy, and unlike the impulse that stops the sliding at once, where there is room for it,
// it does not jump from one iteration to the next.
double SweptImpulse::correct() {
  const double normal = raise_normal(dot(normal_, relative_change()));
  if (normal != 0.0) apply(normal * normal_);
  const double by_normal = std::abs(normal) * mobility_;
  if (!may_rub()) return by_normal;
  Vec4d slides = relative_change() + sliding_;
  slides -= dot(slides, normal_) * normal_;
  const Vec4d after =
      within(friction_ * pressing(), friction_impulse_ - min_tangent_mass_ * slides);
  const Vec4d given = after - friction_impulse_;
  friction_impulse_ = after;
  apply(given);
  return std::max(by_normal, std::sqrt(dot(given, given)) / min_tangent_mass_);
}

double SweptImpulse::work(const Vec3& before) const { return given().dot(before + 0.5 * change()); }

}  // namespace pneuma::sim
