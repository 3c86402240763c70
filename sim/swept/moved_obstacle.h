// An obstacle that is moved and keeps its shape. Of its vertices a step places only those that
// something comes near.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/collision/feature_tests.h"
#include "sim/soft/pins.h"
#include "sim/swept/moving_surface.h"
#include "sim/swept/obstacle_frame.h"
#include "sim/swept/obstacle_search.h"

namespace pneuma::sim {

class MovedObstacle {
 public:
  /// `margin`: m, of the boxes about its vertices.
  MovedObstacle(std::shared_ptr<const SurfaceTree> tree, const SoftBody& body, double margin);

  /// A step does not move it in the world, where it stays as the whole step began until it is done.
  void leave_in_place() { is_driven_ = true; }
  bool is_driven() const { return is_driven_; }
  /// Moves it, or leaves it behind if it may and if its motion says where it is.
  void end_step(SoftBody& body, bool may_leave_behind);
  /// Brings one that was left behind to where it is after so many steps.
  void catch_up(SoftBody& body, const Settings& settings, std::int64_t steps);

  /// Of a whole step, before all else.
  void begin_step(const SoftBody& body, const Settings& settings, std::int64_t steps);
  /// Whether its motion leads elsewhere in this step.
  bool moves() const;
  /// `parts_done`: fractions of a step that is halved, of which this is the next; `fraction`: its
  /// own. Nothing is placed. `start` is unused of one that is left in place.
  void begin_part(const SoftBody& body, const SoftState& start, std::span<const double> parts_done,
                  double fraction);

  /// Whether it lies where its motion puts it and is turned by little, so that it may be seen in
  /// its own axes.
  bool is_in_own_axes() const { return is_in_own_axes_; }
  const ObstacleFrame& frame() const { return frame_; }
  /// As it lies in its own axes, fitted.
  const MovingSurface& own() const { return own_; }
  /// Gives `seen` the ways of another surface in these axes, and boxes about them that are wide
  /// enough.
  void look_at(const MovingSurface& other, MovingSurface& seen) const;
  /// Its features that a soft body may touch. `seen`: gets the ways of this in its axes; `near`,
  /// `least` and `allowance`: m, in the world.
  BesideObstacle beside(const MovingSurface& soft, MovingSurface& seen, double near, double least,
                        double allowance) const;
  /// About its way, with its margin.
  Bounds bounds_of_way() const { return frame_.way_of(own_bounds()); }
  /// m, of a vertex at most.
  double longest_way() const { return frame_.longest_way(own_bounds()); }

  /// m/s, of a vertex of one that is left in place.
  Vec3 velocity(const SoftBody& body, int vertex) const;
  /// Gives a surface the ways of the vertices of a feature and of their neighbours.
  void place_around(const SoftBody& body, const SoftState& start, const Feature& feature,
                    MovingSurface& surface);
  void place_all(const SoftBody& body, const SoftState& start, MovingSurface& surface) const;

 private:
  bool lies_in_own_axes(const SoftBody& body, const SoftState& start);
  Bounds own_bounds() const;
  Vec3 start_of_step(const SoftBody& body, int vertex) const;
  Segment way(const SoftBody& body, const SoftState& start, int vertex) const;

  MovingSurface own_;
  ObstacleShape shape_;
  bool is_driven_ = false;
  bool is_left_behind_ = false;  // in an earlier step
  double step_ = 0.0;            // s, the whole one
  PinPlaces start_, end_;        // of it
  ObstacleFrame frame_;          // of the part
  std::span<const double> parts_done_;
  double fraction_ = 1.0;
  bool is_in_own_axes_ = false;
  bool has_lain_in_own_axes_ = false;  // with all its vertices, once
  std::uint64_t part_ = 1;
  std::vector<std::uint64_t> placed_;  // per vertex: the part in which it was
};

}  // namespace pneuma::sim
