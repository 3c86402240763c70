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

/// A direction in which an impulse acts on two boxes, one N s of it.
struct Axis {
  Vec4d along;
  Vec4d first_lever, second_lever;  // about the centres, m
  Vec4d first_turn, second_turn;    // rad/s
};

/// Two boxes, or one and what nothing moves, whose changes stay in registers until they are kept.
/// What does not depend on them is computed for each axis, so that impulses wait for few operations
/// of those before.
class TwoBoxes {
 public:
  TwoBoxes(const SweptSide& first, const SweptSide& second) : first_(first), second_(second) {}

  Axis axis(Vec4d along) const {
    const Vec4d first = cross(first_.arm, along), second = cross(second_.arm, along);
    return {along, first, second, first_.inverse_inertia * first, second_.inverse_inertia * second};
  }
  /// m/s, by which the first point moves along the axis against the second.
  double change(const Axis& axis) const {
    return sum_of_lanes(axis.along * (first_.velocity - second_.velocity) +
                        axis.first_lever * first_.angular_velocity -
                        axis.second_lever * second_.angular_velocity);
  }
  void apply(const Axis& axis, double impulse) {
    first_.velocity += (first_.inverse_mass * impulse) * axis.along;
    second_.velocity -= (second_.inverse_mass * impulse) * axis.along;
    first_.angular_velocity += impulse * axis.first_turn;
    second_.angular_velocity -= impulse * axis.second_turn;
  }
  void keep() const {
    first_.keep();
    second_.keep();
  }

 private:
  struct Side {
    explicit Side(const SweptSide& side) : box(side.box()) {
      if (!box) return;
      velocity = box->velocity;
      angular_velocity = box->angular_velocity;
      inverse_mass = box->inverse_mass;
      inverse_inertia = box->inverse_inertia;
      arm = side.arm();
    }
    void keep() const {
      if (!box) return;
      box->velocity = velocity;
      box->angular_velocity = angular_velocity;
    }

    BoxChange* box;
    Vec4d velocity{}, angular_velocity{};
    double inverse_mass = 0.0;
    Mat3x4 inverse_inertia{};
    Vec4d arm{};
  };

  Side first_;
  Side second_;
};

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

Mat3 SweptSide::mobility() const {
  if (box_) {
    const Mat3 arm = cross_matrix(to_vec3(arm_));
    Mat3 inverse;
    for (int i = 0; i < 3; ++i) inverse.col(i) = to_vec3(box_->inverse_inertia.columns[at(i)]);
    return box_->inverse_mass * Mat3::Identity() - arm * inverse * arm;
  }
  double sum = 0.0;
  for (const double weight : weights_) sum += weight * weight;
  return sum * inverse_vertex_mass_ * Mat3::Identity();
}

SweptImpulse::SweptImpulse(SweptSide first, SweptSide second, const Vec3& normal, double friction)
    : first_(first), second_(second), normal_(to_vec4d(normal)), friction_(friction) {
  const Mat3 mobility = first_.mobility() + second_.mobility();
  mobility_ = normal.dot(mobility * normal);
  normal_mass_ = 1.0 / mobility_;
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = normal.unitOrthogonal();
  across.col(1) = normal.cross(across.col(0));
  tangent_ = to_vec4d(across.col(0));
  const Eigen::Matrix2d along = across.transpose() * mobility * across;
  const double half_difference = 0.5 * (along(0, 0) - along(1, 1));
  min_tangent_mass_ = 1.0 / (0.5 * along.trace() + std::hypot(half_difference, along(0, 1)));
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
  const Vec4d across = within(friction_ * pressing, whole - along * normal_);
  normal_impulse_ += pressing;
  friction_impulse_ += across;
  apply(pressing * normal_ + across);
}

/// lambda = clamp(lambda_0 + k (wanted - n.u)), and the potential of which it is the gradient:
///   max over lambda of  lambda (wanted - n.u) - (lambda - lambda_0)^2 / (2 k).
void SweptImpulse::respond_along_normal(Vec4d change, double penalty, Response& response) const {
  const double stiffness = penalty * normal_mass_;
  const double missing = parting_ - dot(normal_, change);
  const double tried = normal_impulse_ + stiffness * missing;
  const double normal = std::clamp(tried, 0.0, max_normal_);
  const double more = normal - normal_impulse_;
  response.given += normal * normal_;
  response.potential += normal * missing - 0.5 * more * more / stiffness;
  if (normal != tried) return;
  const Vec3 n = to_vec3(normal_);
  response.stiffness += stiffness * n * n.transpose();
}

/// Likewise across the normal, within the disc that the normal impulse allows as it is.
void SweptImpulse::respond_with_friction(Vec4d change, double penalty, Response& response) const {
  const double limit = friction_ * normal_impulse_;
  if (limit == 0.0) return;
  const double stiffness = penalty * min_tangent_mass_;
  Vec4d slides = change + sliding_;
  slides -= dot(slides, normal_) * normal_;
  const Vec4d tried = friction_impulse_ - stiffness * slides;
  const Vec4d friction = within(limit, tried);
  const Vec4d more = friction - friction_impulse_;
  response.given += friction;
  response.potential -= dot(friction, slides) + 0.5 * dot(more, more) / stiffness;
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
  response.potential += dot(start(), change);
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

void SweptImpulse::exceed(Vec4d impulse) {
  const double along = dot(impulse, normal_);
  normal_impulse_ += along;
  friction_impulse_ += impulse - along * normal_;
  apply(impulse);
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
  return friction_ * normal_impulse_ != 0.0 || dot(friction_impulse_, friction_impulse_) != 0.0;
}

double SweptImpulse::correct() {
  const bool first_is_soft = first_.moves() && !first_.box();
  const bool second_is_soft = second_.moves() && !second_.box();
  return first_is_soft || second_is_soft ? correct_sides() : correct_boxes();
}

// A step against the sliding, then the nearest point in the cone: from within the cone it never
// adds energy, and unlike the impulse that stops the sliding at once, where there is room for it,
// it does not jump from one iteration to the next.
double SweptImpulse::correct_sides() {
  const double normal = raise_normal(dot(normal_, relative_change()));
  if (normal != 0.0) apply(normal * normal_);
  const double by_normal = std::abs(normal) * mobility_;
  if (!may_rub()) return by_normal;
  Vec4d slides = relative_change() + sliding_;
  slides -= dot(slides, normal_) * normal_;
  const Vec4d after =
      within(friction_ * normal_impulse_, friction_impulse_ - min_tangent_mass_ * slides);
  const Vec4d given = after - friction_impulse_;
  friction_impulse_ = after;
  apply(given);
  return std::max(by_normal, std::sqrt(dot(given, given)) / min_tangent_mass_);
}

/// The same, with friction in two directions across the normal.
double SweptImpulse::correct_boxes() {
  TwoBoxes boxes(first_, second_);
  const Axis along = boxes.axis(normal_);
  const double normal = raise_normal(boxes.change(along));
  boxes.apply(along, normal);
  double change = std::abs(normal) * mobility_;
  if (may_rub()) {
    const Axis one = boxes.axis(tangent_), other = boxes.axis(cross(normal_, tangent_));
    const double before = dot(friction_impulse_, one.along);
    const double other_before = dot(friction_impulse_, other.along);
    double after = before - min_tangent_mass_ * (boxes.change(one) + dot(sliding_, one.along));
    double other_after =
        other_before - min_tangent_mass_ * (boxes.change(other) + dot(sliding_, other.along));
    const double limit = friction_ * normal_impulse_,
                 squared = after * after + other_after * other_after;
    if (squared > limit * limit) {
      const double shorter = limit / std::sqrt(squared);
      after *= shorter;
      other_after *= shorter;
    }
    friction_impulse_ = after * one.along + other_after * other.along;
    const double given = after - before, other_given = other_after - other_before;
    boxes.apply(one, given);
    boxes.apply(other, other_given);
    change =
        std::max(change, std::sqrt(given * given + other_given * other_given) / min_tangent_mass_);
  }
  boxes.keep();
  return change;
}

double SweptImpulse::work(const Vec3& before) const { return given().dot(before + 0.5 * change()); }

}  // namespace pneuma::sim
