// The bodies of a world as surfaces that move through a step and that impulses act on. Private to
// sim/step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/collision/sweep_and_prune.h"
#include "sim/response/carried_boxes.h"
#include "sim/step/stages/stage_memory.h"
#include "sim/swept/moved_obstacle.h"
#include "sim/swept/obstacle_search.h"
#include "sim/swept/swept_impulse.h"

namespace pneuma::sim {

/// A point of a body: where a feature of its surface is nearest to another body.
struct SurfacePoint {
  int body = 0;  // soft bodies, then boxes; or the ground
  Feature feature;
  FeatureWeights weights{};
  Vec3 point = Vec3::Zero();  // m
};
inline constexpr int swept_ground = -1;  // in place of a body: nothing moves it

/// Of the shorter of their shortest sides: boxes no further apart at the start of the step touch in
/// the points of one contact, as boxes, and not by their features.
inline constexpr double near_of_side = 0.02;
/// A way's box is this many skins larger: surfaces are found before they are too near.
inline constexpr double skins_around = 1.5;

class SweptBodies {
 public:
  explicit SweptBodies(const World& world);
  /// Per soft body: these obstacles are where the whole step began until it is done.
  void leave_in_place(std::span<const std::uint8_t> is_driven);
  /// Moves such an obstacle, or leaves it behind if it may and if its motion says where it is.
  void end_step(SoftBody& body, int number, bool may_leave_behind);
  void place_left_behind(World& world);
  /// Of the whole step, before all else.
  void begin_step(const World& world);
  /// Whether a body of this step has a velocity.
  bool moves(const World& world, int body) const;
  /// The ground does, and what nothing moves in this step.
  bool stands_still(const World& world, int body) const;
  bool any_driven_moves() const;
  /// Whether it may move where no impulse moves it: an obstacle or box that is moved, or a soft
  /// body, whose vertices may be pinned.
  bool pushes(int body) const { return body != swept_ground && pushes_[at(body)] != 0; }

  int count() const { return static_cast<int>(surfaces_.size()); }
  bool is_rigid(int body) const { return body >= soft_count_; }
  bool is_box(int body) const { return body != swept_ground && is_rigid(body); }
  /// Index into World::rigid.
  int box(int body) const { return body - soft_count_; }
  /// The body that a box is, or -1 the ground.
  int of_box(int box) const { return box < 0 ? swept_ground : box + soft_count_; }
  /// For those who ask for contacts and for messages. `feature`: of a soft body.
  ContactSide contact_side(int body, const Feature& feature) const;
  std::string name(const World& world, int body) const;
  /// Of a box, from the start to the end.
  const Mat3& turn(int box) const { return turns_[at(box)]; }
  const MovingSurface& surface(int body) const { return surfaces_[at(body)]; }
  /// Whether it is a soft body that is an obstacle and keeps its shape.
  bool is_obstacle(int body) const { return obstacles_[at(body)] || is_in_own_axes(body); }
  /// Whether they are boxes, obstacles or the ground: no contact changes their shape.
  bool keep_shapes(const BodyPair& bodies) const {
    const auto keeps_shape = [this](int body) { return is_rigid(body) || is_obstacle(body); };
    return keeps_shape(bodies.first) &&
           (bodies.second == swept_ground || keeps_shape(bodies.second));
  }
  /// The ways of a soft body beside an obstacle, in the axes of this if it is moved. `near` and
  /// `least`: m, in the world.
  BesideObstacle beside_obstacle(int soft, int obstacle, double near, double least);
  /// Of an obstacle only what has been placed has a start and an end, and its neighbours.
  void place_around(const World& world, const MotionStart& start, int obstacle,
                    const Feature& feature);
  /// The features of two bodies whose ways may come near each other, in the axes of an obstacle if
  /// one is moved.
  void find_features(const World& world, const MotionStart& start, const BodyPair& bodies,
                     std::vector<NearFeatures>& found);
  /// m, half of what bodies of this kind keep between their surfaces.
  double skin(int body) const { return skins_[at(body)]; }
  double thinnest_skin() const { return *std::min_element(skins_.begin(), skins_.end()); }

  /// Where the surfaces are at the start of a step, and at its end; of a soft body from when
  /// another body's way may come near its own. `parts_done`: fractions of a step that is halved, of
  /// which this is the next; `fraction`: its own.
  void set_start(const World& world, const MotionStart& start, std::span<const double> parts_done,
                 double fraction);
  void set_end(const World& world);
  /// Of one box.
  void set_end(const World& world, int body);

  /// Forgets the changes of velocity. Impulses will act on the bodies as they are at the start of
  /// the step, or as they are now, at its end.
  void begin_at_start(const World& world, const MotionStart& start);
  void begin_at_end(const World& world);

  /// Fills `pairs` with the bodies whose ways come near each other, in ascending order. Their ways
  /// may then end elsewhere by the allowance of each body without another search.
  void find_near_bodies(const World& world, const MotionStart& start, std::vector<BodyPair>& pairs);
  /// As the last search found them: boxes that stand still and that a soft body is near, in pairs
  /// with it.
  std::span<const BodyPair> still_boxes_near(int soft) const;
  /// Whether the last search was for these ways of two boxes, though it was not the first.
  bool is_as_searched(const BodyPair& bodies) const {
    return is_rigid(bodies.first) && is_refitted_[at(bodies.first)] == 0 &&
           is_refitted_[at(bodies.second)] == 0;
  }
  /// Whether `visit(body)` is true for another body whose way comes near one of these bodies',
  /// which it would go besides its own.
  template <class Visit>
  bool any_near_way(const Bounds& way, const BodyPair& bodies, const Visit& visit) const {
    for (int i = 0; i < count(); ++i) {
      if (i == bodies.first || i == bodies.second || !overlap(ways_[at(i)], way)) continue;
      if (visit(i)) return true;
    }
    return false;
  }
  void add_to_way(int body, const Bounds& way) { ways_[at(body)].include(way); }
  void may_meet(const BodyPair& bodies) {
    is_lone_[at(bodies.first)] = is_lone_[at(bodies.second)] = 0;
  }
  /// Whether a soft body may meet no other body in this step: then its vertices meet the ground
  /// each for itself, once it has moved.
  bool is_lone(int body) const { return is_lone_[at(body)] != 0; }
  /// m.
  double allowance(int body) const { return allowances_[at(body)]; }
  /// Whether all ends are still within the allowances.
  bool search_is_valid() const;
  /// From where a vertex ends towards another place, as far as its body's allowance reaches, m.
  Vec3 within_allowance(int body, int vertex, const Vec3& end, const Vec3& place) const;

  /// The axes of a box at the start of the step and at its end.
  const Mat3& start_axes(int body) const { return start_axes_[at(box(body))]; }
  const Mat3& end_axes(int body) const { return end_axes_[at(box(body))]; }

  /// m, where a point with these weights is at the start of the step.
  Vec3 start_point(const SurfacePoint& point) const;
  SweptSide side(const World& world, const SurfacePoint& point);
  /// Calls `visit(number)` for what an impulse at the point may move at once: the vertices of its
  /// feature, or the box. The numbers are below node_count().
  template <class Visit>
  void for_each_node(const SurfacePoint& point, const Visit& visit) const;
  int node_count() const { return first_nodes_.back(); }
  int node_of(int soft, int vertex) const { return first_nodes_[at(soft)] + vertex; }
  /// m, at the start of the step, of what is at a point of a box at its end.
  Vec3 point_before(const World& world, const MotionStart& start, int body,
                    const Vec3& at_end) const;
  /// Whether some soft body has pinned vertices, so that a side of it may not move.
  bool has_pins() const { return has_pins_; }
  /// m, from the start of the step to its end.
  Vec3 displacement(const World& world, const MotionStart& start, const SurfacePoint& point) const;
  /// m/s.
  Vec3 start_velocity(const World& world, const MotionStart& start,
                      const SurfacePoint& point) const;
  Vec3 end_velocity(const World& world, const SurfacePoint& point) const;

  /// Takes a part of the changes since begin_at_start as displacements, in m and rad, that the
  /// boxes are given in this step besides their motion, and forgets them; without it there are
  /// none.
  void take_as_shifts(double part);
  void forget_shifts() { shifts_.clear(); }
  /// m, by which the shifts move a point of a box; zero of others.
  Vec3 shift(const SurfacePoint& point) const;
  /// J, the work of the shifts against gravity.
  double work_of_shifts(const World& world) const;
  /// kg m^2/s, by which a box's shift changes its angular momentum, at the velocities that it has.
  Vec3 angular_momentum_of_shift(const World& world, int box) const;
  bool has_shifts() const { return !shifts_.empty(); }
  /// Gives the boxes their shifts.
  void shift_boxes(World& world) const;

  /// Moves the boxes that soft bodies carry, at the end of their free motion, by `way_of_carried`
  /// (m) as part of it, and others that nothing bears (`is_borne`: per box) by their missing_fall;
  /// in this step, also where they are moved again. Whether there is any.
  bool let_fall(World& world, const MotionStart& start, const CarriedBoxes& carried,
                const Vec3& way_of_carried, std::span<const std::uint8_t> is_borne);

  /// Moves the bodies that impulses have changed once more, from their start with other velocities.
  std::optional<Divergence> move_again(World& world, const MotionStart& start,
                                       IntegrateSoftMemory& integrate_soft);
  /// Adds the changes to the velocities at the end of the step.
  void add_changes(World& world) const;

 private:
  void know_obstacle(const SoftBody& body);
  void number_nodes(const World& world);
  /// What refit_way would give, of a body that is not followed.
  Bounds bounds_of_way(const World& world, const MotionStart& start, int soft) const;
  Bounds refit_way(const World& world, const MotionStart& start, int body);
  /// `allowed`: m, by which the end may move before another search, besides a skin.
  void refit_anew(int body, double allowed);
  Bounds root_bounds(int body) const;
  bool may_be_near(const BodyPair& bodies) const;
  bool is_moved(const World& world, int body) const;
  void find_what_is_still(const World& world);
  bool is_in_own_axes(int body) const {
    return moved_[at(body)] && moved_[at(body)]->is_in_own_axes();
  }
  bool is_driven(int body) const { return moved_[at(body)] && moved_[at(body)]->is_driven(); }
  void see_in_own_axes(int obstacle);
  /// Whether only its vertices that are reached have been placed.
  bool is_placed_as_needed(int body) const {
    return is_in_own_axes(body) && is_followed_[at(body)] == 0;
  }
  void place_all(const World& world, const MotionStart& start, int body);
  Vec3 driven_velocity(const World& world, const SurfacePoint& point) const;
  Bounds bounds_of_still(const World& world, int body);
  void fit_still(const World& world, int body);
  SweptSide pinned_side(const SoftBody& body, const SurfacePoint& point);
  bool is_within_allowance(int body) const;
  void follow(const World& world, const MotionStart& start, int soft);
  std::span<const int> vertices(const SurfacePoint& point) const;
  /// `motion(i)` of each box.
  template <class MotionOf>
  void begin(const World& world, const MotionOf& motion);
  /// `value` of each vertex of the point's feature.
  template <class Value>
  Vec3 interpolate(const SurfacePoint& point, const Value& value) const;
  bool is_to_move_again(int soft) const;
  const SoftState& kick(const MotionStart& start, int soft);
  std::optional<Divergence> move_again(World& world, const MotionStart& start, JoinedStep& group,
                                       IntegrateSoftMemory& integrate_soft);
  void add_falls(World& world) const;
  void place_corners(int box, const Vec3& position, const Mat3& axes, VertexArray& corners) const;

  int soft_count_ = 0;
  std::vector<MovingSurface> surfaces_;
  std::vector<int> first_nodes_;                           // of each body, and the end
  std::vector<std::uint8_t> is_lone_;                      // per body
  std::vector<std::unique_ptr<ObstacleShape>> obstacles_;  // per body that never moves, or null
  std::vector<std::unique_ptr<MovedObstacle>> moved_;      // per body, or null
  std::vector<MovingSurface> seen_;                        // per body: from an obstacle
  std::vector<std::uint8_t> never_moves_;                  // per body
  std::vector<std::uint8_t> is_still_;     // per body: as it never moves, or is asleep
  std::vector<std::uint8_t> pushes_;       // per body
  std::vector<std::uint8_t> is_fitted_;    // per body: as it lies still
  bool has_pins_ = false;                  // any soft body
  std::vector<std::uint8_t> is_followed_;  // per body: whether its surface is that of this step
  std::vector<std::uint8_t> is_searched_;  // per body: whether a search of this step was for it
  std::vector<std::uint8_t> is_refitted_;  // per body: whether the last search fitted its boxes
  std::vector<double> skins_;
  std::vector<double> shortest_sides_;  // of the boxes, m
  std::vector<double> allowances_;
  std::vector<VertexArray> searched_ends_;                  // the ends that the last search was for
  std::vector<VertexArray> corners_;                        // of the boxes, in their own axes, m
  std::vector<std::unique_ptr<const MeshTopology>> boxes_;  // their triangles
  std::vector<VertexArray> changes_;                        // m/s, per soft body
  std::vector<std::uint8_t> may_be_changed_;  // per soft body: an impulse got a side of it
  std::vector<Mat3> start_axes_, end_axes_;   // of the boxes
  std::vector<Mat3> turns_;                   // of the boxes, from the start to the end
  std::vector<BoxChange> box_changes_;
  std::vector<BoxChange> shifts_;          // of the boxes, or empty
  std::vector<Vec3> falls_;                // m, of the boxes, within the step
  std::vector<std::uint8_t> moved_again_;  // per soft body, in this step
  std::vector<SoftState> kicked_;          // per soft body
  std::vector<Bounds> ways_;               // per body, with what it keeps around it
  std::vector<Bounds> reached_;            // the same, with what a box reaches for others
  SweepAndPrune sweep_and_prune_;
  std::vector<BodyPair> beside_still_boxes_;  // soft bodies, in the order of their numbers
};

template <class Visit>
void SweptBodies::for_each_node(const SurfacePoint& point, const Visit& visit) const {
  const int first = first_nodes_[at(point.body)];
  if (is_rigid(point.body)) {
    visit(first);
  } else {
    for (const int vertex : vertices(point)) visit(first + vertex);
  }
}

}  // namespace pneuma::sim
