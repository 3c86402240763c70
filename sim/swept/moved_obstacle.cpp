#include "sim/swept/moved_obstacle.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace pneuma::sim {
namespace {

/// Of where a vertex is, m and more: that much is rounding.
constexpr double rounding = 1e-9;

bool are_same(const Vec3& one, const Vec3& other) {
  return (one - other).norm() <= rounding * (1.0 + one.norm());
}

}  // namespace

MovedObstacle::MovedObstacle(std::shared_ptr<const SurfaceTree> tree, const SoftBody& body,
                             double margin)
    : shape_(tree->topology(), body.pins->start), placed_(at(body.positions.size())) {
  own_.tree = std::move(tree);
  own_.start = own_.end = body.pins->start;
  refit(own_, margin);
  shape_.keep_place(own_);
}

void MovedObstacle::begin_step(const SoftBody& body, const Settings& settings, std::int64_t steps) {
  step_ = time_step(settings);
  const double steps_per_second = settings.steps_per_second;
  start_ = {*body.pins, static_cast<double>(steps) / steps_per_second};
  end_ = {*body.pins, static_cast<double>(steps + 1) / steps_per_second};
}

void MovedObstacle::end_step(SoftBody& body, bool may_leave_behind) {
  if (may_leave_behind && is_in_own_axes_) {
    is_left_behind_ = true;
    return;
  }
  for (int v = 0; v < body.positions.size(); ++v) {
    const Vec3 place = end_[v];
    body.velocities[v] = (place - start_of_step(body, v)) / step_;
    body.positions[v] = place;
  }
  is_left_behind_ = false;
}

void MovedObstacle::catch_up(SoftBody& body, const Settings& settings, std::int64_t steps) {
  if (!is_left_behind_) return;
  begin_step(body, settings, steps - 1);
  end_step(body, false);
}

bool MovedObstacle::moves() const {
  return start_.turn() != end_.turn() || start_.origin() != end_.origin();
}

void MovedObstacle::begin_part(const SoftBody& body, const SoftState& start,
                               std::span<const double> parts_done, double fraction) {
  ++part_;
  parts_done_ = parts_done;
  fraction_ = fraction;
  const double from = std::accumulate(parts_done.begin(), parts_done.end(), 0.0);
  frame_.set({start_.turn(), start_.origin()}, {end_.turn(), end_.origin()}, from, from + fraction);
  is_in_own_axes_ = frame_.is_of_use() && lies_in_own_axes(body, start);
}

/// Looks at all vertices once, and then at a few: whoever moves an obstacle otherwise than by its
/// motion moves all of it.
bool MovedObstacle::lies_in_own_axes(const SoftBody& body, const SoftState& start) {
  const VertexArray& own = own_.start;
  const int step = has_lain_in_own_axes_ ? std::max(1, own.size() / 4) : 1;
  for (int v = 0; v < own.size(); v += step) {
    const auto [from, to] = way(body, start, v);
    const Vec3 vertex = own[v];
    if (!are_same(frame_.start() * vertex, from) || !are_same(frame_.end() * vertex, to)) {
      return false;
    }
  }
  has_lain_in_own_axes_ = true;
  return true;
}

Bounds MovedObstacle::own_bounds() const {
  const WayBox& around = own_.nodes.front();
  return {to_vec3(around.low), to_vec3(around.high)};
}

void MovedObstacle::look_at(const MovingSurface& other, MovingSurface& seen) const {
  const double bend = frame_.look_at(other.start, other.end, seen.start, seen.end);
  refit(seen, frame_.own_change(other.margin) + bend);
}

BesideObstacle MovedObstacle::beside(const MovingSurface& soft, MovingSurface& seen, double near,
                                     double least, double allowance) const {
  const double bend = frame_.look_at(soft.start, soft.end, seen.start, seen.end);
  return {.soft = seen,
          .obstacle = own_,
          .shape = shape_,
          .near = frame_.own_length(near) + bend,
          .least = frame_.own_length(least) + bend,
          .allowance = frame_.own_change(allowance)};
}

Vec3 MovedObstacle::start_of_step(const SoftBody& body, int vertex) const {
  return is_left_behind_ ? start_[vertex] : Vec3(body.positions[vertex]);
}

Vec3 MovedObstacle::velocity(const SoftBody& body, int vertex) const {
  return (end_[vertex] - start_of_step(body, vertex)) / step_;
}

/// To the last bit what hold_pins would make of it, part by part.
Segment MovedObstacle::way(const SoftBody& body, const SoftState& start, int vertex) const {
  if (!is_driven_) return {start.positions[vertex], body.positions[vertex]};
  const Vec3 velocity = this->velocity(body, vertex);
  Vec3 from = start_of_step(body, vertex);
  for (const double part : parts_done_) from += part * step_ * velocity;
  return {from, from + fraction_ * step_ * velocity};
}

void MovedObstacle::place_around(const SoftBody& body, const SoftState& start,
                                 const Feature& feature, MovingSurface& surface) {
  const MeshTopology& topology = own_.tree->topology();
  const auto place = [&](int vertex) {
    if (placed_[at(vertex)] == part_) return;
    placed_[at(vertex)] = part_;
    const auto [from, to] = way(body, start, vertex);
    surface.start[vertex] = from;
    surface.end[vertex] = to;
  };
  for (const int vertex : topology.feature_vertices(feature)) {
    place(vertex);
    for (const MeshTopology::Spoke& spoke : topology.ring(vertex)) place(spoke.vertex);
  }
}

void MovedObstacle::place_all(const SoftBody& body, const SoftState& start,
                              MovingSurface& surface) const {
  for (int v = 0; v < surface.start.size(); ++v) {
    const auto [from, to] = way(body, start, v);
    surface.start[v] = from;
    surface.end[v] = to;
  }
}

}  // namespace pneuma::sim
