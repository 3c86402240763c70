// The impulse between two features that are kept apart while they move (ERRATA row 67), and what it
// acts on.
//
// Where the features are nearest, each side is a point with weights of its vertices. An impulse
// goes to the vertices by these weights, so that it has a line of action: the one through both
// points if it is along the normal. Then linear momentum is kept to rounding and so is angular
// momentum; friction turns the pair by at most gap times impulse.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "sim/mesh/vec4d.h"
#include "sim/mesh/vertex_array.h"
#include "sim/swept/closest_points.h"
#include "sim/world/rigid_box.h"

namespace pneuma::sim {

/// By how much impulses have changed the velocities of a box, and what an impulse does to it.
struct BoxChange {
  Vec4d centre{};    // m
  Vec4d velocity{};  // m/s
  Vec4d angular_velocity{};
  double inverse_mass = 0.0;  // 1/kg
  Mat3x4 inverse_inertia{};   // world axes, 1/(kg m^2)
  /// Of the impulses on it that iterations have sorted (ConjugateIterations), one bit each.
  std::uint64_t colours = 0;
};

/// Without a change as yet, of a box that lies there.
BoxChange make_box_change(const RigidBox& box, const Vec3& position,
                          const Eigen::Quaterniond& orientation);

/// A point of one side that impulses act on. Refers to the changes of velocity that they make.
class SweptSide {
 public:
  SweptSide() = default;  // a side that nothing moves
  /// `vertices`: of the feature, as many as it has; their `changes` in m/s.
  SweptSide(VertexArray& changes, std::span<const int> vertices, const FeatureWeights& weights,
            double vertex_mass);
  SweptSide(BoxChange& box, const Vec3& point);

  /// Change of the point's velocity so far, m/s.
  Vec4d change() const {
    return box_ ? box_->velocity + cross(box_->angular_velocity, arm_) : change_of_vertices();
  }
  /// N s.
  void apply(Vec4d impulse) const {
    if (!box_) return apply_to_vertices(impulse);
    box_->velocity += box_->inverse_mass * impulse;
    box_->angular_velocity += box_->inverse_inertia * cross(arm_, impulse);
  }
  void apply_beside_boxes(Vec4d impulse) const {
    if (!box_) apply_to_vertices(impulse);
  }
  /// The velocity in m/s along one axis that one N s along the other gives to the point, 1/kg.
  double mobility(Vec4d axis, Vec4d other) const;

  /// False of the ground and of boxes that nothing moves.
  bool moves() const { return box_ || count_ > 0; }
  /// What an impulse moves: a box, or so many vertices (their changes); neither, if nothing moves
  /// the side.
  BoxChange* box() const { return box_; }
  Vec4d arm() const { return arm_; }
  std::span<double* const> vertices() const { return std::span(vertices_).first(at(count_)); }
  double weight(std::size_t vertex) const { return weights_[vertex]; }
  double vertex_mass() const { return 1.0 / inverse_vertex_mass_; }

 private:
  Vec4d change_of_vertices() const;
  void apply_to_vertices(Vec4d impulse) const;

  std::array<double*, 3> vertices_{};
  FeatureWeights weights_{};
  int count_ = 0;
  double inverse_vertex_mass_ = 0.0;
  BoxChange* box_ = nullptr;
  Vec4d arm_{};  // from the box's centre to the point, m
};

/// One contact of a Gauss-Seidel solver with Coulomb's friction. Changes of the relative velocity
/// are asked for, in m/s: how they come from displacements or velocities is the caller's.
class SweptImpulse {
 public:
  SweptImpulse(SweptSide first, SweptSide second, const Vec3& normal, double friction);

  /// What is wanted: that impulses change the velocity along the normal by at least `parting`, and
  /// across it by -`sliding`.
  void aim(double parting, const Vec3& sliding);
  /// Starts from an impulse that was given before and may be taken back, but no more than that.
  void start_from(double normal, const Vec3& friction);
  /// Lets what it is count from there on: what it was given stays, and limits hold for the rest.
  void count_from(double normal, const Vec3& friction);
  /// Gives an impulse (N s) at once: what the same contact needed in the last step.
  void warm_start(const Vec3& impulse);
  /// From now on gives no more than so much (N s) along the normal, besides what it started from;
  /// nothing, if it only gives back.
  void limit(double normal) {
    if (max_normal_ > start_normal_) max_normal_ = start_normal_ + normal;
  }
  /// What presses the sides together besides (N s), so that they rub without a normal impulse.
  void squeeze(double impulse) { squeeze_ = impulse; }
  /// The same (N s), of what other impulses may relieve: up to that, the sides do not part either.
  void press(double impulse) {
    pressed_ = impulse;
    normal_impulse_ += impulse;
    start_normal_ += impulse;
  }
  /// Gives no more along the normal than it started from.
  void only_give_back() { max_normal_ = start_normal_; }
  bool only_gives_back() const { return max_normal_ == start_normal_; }

  const SweptSide& first() const { return first_; }
  const SweptSide& second() const { return second_; }
  /// Neither side is soft.
  bool is_of_boxes() const {
    return (first_.box() || !first_.moves()) && (second_.box() || !second_.moves());
  }

  /// A step of the augmented Lagrangian from the impulse as it is.
  struct Response {
    Vec4d given{};                  // N s on the first side, without what was started from
    Mat3 stiffness = Mat3::Zero();  // by which it grows against the change, N s per m/s
  };
  /// The impulse if all of them together changed the relative velocity by `change` (m/s): `penalty`
  /// times what would close the gap to what is wanted if it acted alone, within its limits.
  Response respond(Vec4d change, double penalty) const;
  /// Lets it be `given` (N s) from now on, without what it was started from.
  void replace_given(Vec4d given);

  /// One projected Gauss-Seidel correction. Returns by how much the relative velocity changed, m/s.
  double correct();

  /// Adds to the impulse (N s) whatever its limits, which hold again after the next correction. To
  /// vertices only: boxes are given it by the caller.
  void exceed_beside_boxes(Vec4d impulse);
  /// N s on the first side, together with what was started from.
  Vec4d impulse() const { return normal_impulse_ * normal_ + friction_impulse_; }
  double mobility() const { return mobility_; }  // 1/kg, along the normal
  Vec3 normal() const { return to_vec3(normal_); }
  bool has_friction() const { return friction_ > 0.0; }

  /// m/s, that is wanted along the normal.
  double parting() const { return parting_; }
  /// N s on the first side, together with what was started from: >= 0.
  double normal_impulse() const { return normal_impulse_; }
  /// N s on the first side, without that.
  double normal_given() const { return normal_impulse_ - start_normal_; }
  Vec3 friction_impulse() const { return to_vec3(friction_impulse_); }
  /// N s, by which the sides are pressed together: friction gives no more than mu times that.
  double pressing() const { return normal_impulse_ + squeeze_; }
  /// Whether it gives anything, or could, as what presses the sides besides may be used up.
  bool may_act() const { return pressing() > 0.0 || pressed_ > 0.0; }
  /// N s on the first side, without what was started from.
  Vec3 given() const {
    return to_vec3((normal_impulse_ - start_normal_) * normal_ +
                   (friction_impulse_ - start_friction_));
  }
  /// Change of the relative velocity by all impulses so far, m/s.
  Vec3 change() const { return to_vec3(relative_change()); }
  /// J, the work of what was given since the start, if the sides had the relative velocity `before`
  /// (m/s) when all impulses began.
  double work(const Vec3& before) const;

 private:
  friend class FourBoxImpulses;

  /// Raises the normal impulse by what the relative velocity's `change` along it (m/s) asks for;
  /// returns by how much, N s.
  double raise_normal(double change);
  bool may_rub() const;
  Vec4d relative_change() const { return first_.change() - second_.change(); }
  Vec4d start() const { return start_normal_ * normal_ + start_friction_; }
  void respond_along_normal(Vec4d change, double penalty, Response& response) const;
  void respond_with_friction(Vec4d change, double penalty, Response& response) const;
  void apply(Vec4d impulse) const;

  SweptSide first_;
  SweptSide second_;
  Vec4d normal_;
  Vec4d tangent_;                  // unit, across it
  double friction_ = 0.0;          // Coulomb's mu
  double normal_mass_ = 0.0;       // kg
  double min_tangent_mass_ = 0.0;  // kg, of the direction across the normal that is moved easiest
  double mobility_ = 0.0;          // 1/kg along the normal
  double parting_ = 0.0;           // m/s
  Vec4d sliding_{};                // m/s, across the normal
  double normal_impulse_ = 0.0;    // N s
  Vec4d friction_impulse_{};
  double start_normal_ = 0.0;
  Vec4d start_friction_{};
  double max_normal_ = std::numeric_limits<double>::infinity();
  double squeeze_ = 0.0;  // N s
  double pressed_ = 0.0;  // N s, of what was started from
};

}  // namespace pneuma::sim
