// Soft bodies with vertices that are held (sim/world/pins.h).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/rigid/given_motion.h"
#include "sim/soft/acceleration.h"
#include "sim/soft/soft_state.h"
#include "sim/world/world.h"

namespace pneuma::sim {

inline bool is_pinned(const SoftBody& body, int vertex) {
  return body.pins && body.pins->is_pinned[at(vertex)] != 0;
}

/// Whether it is an obstacle all of whose vertices stay, or follow its motion.
bool keeps_shape(const SoftBody& body);

/// Of a body as it lies there: `is_pinned` and `follows` are per vertex.
std::shared_ptr<const Pins> make_pins(const VertexArray& positions,
                                      std::vector<std::uint8_t> is_pinned,
                                      std::vector<std::uint8_t> follows, GivenMotion motion);

/// Where a motion puts the vertices that follow it, at a time.
class PinPlaces {
 public:
  PinPlaces() = default;
  /// Refers to the pins; `time` in s.
  PinPlaces(const Pins& pins, double time)
      : pins_(&pins),
        pose_(pose_at(pins.motion, time)),
        turn_(pose_.orientation.toRotationMatrix()) {}

  Vec3 operator[](int vertex) const {
    const Vec3 arm = Vec3(pins_->start[vertex]) - pins_->motion.position;
    return pose_.position + turn_ * arm;
  }
  /// m, of what is not turned about the centre of the motion.
  Vec3 origin() const { return pose_.position - turn_ * pins_->motion.position; }
  const Mat3& turn() const { return turn_; }

 private:
  const Pins* pins_ = nullptr;
  Pose pose_;
  Mat3 turn_;
};

/// Gives the vertices that follow a motion the velocities that lead to where it puts them at the
/// end of the next step.
void aim_pins(SoftBody& body, const Settings& settings, std::int64_t steps);
/// Puts them where they are at a time, s; others stay.
void place_pins(SoftBody& body, double time);

/// Over a step (s) pinned vertices keep the velocities that they had at its start: undoes what else
/// has been done to them.
void hold_pins(SoftBody& body, const SoftState& start, double step);

/// The accelerations of a body's vertices, of which pinned ones have none.
class PinnedAccelerations {
 public:
  PinnedAccelerations(const Accelerations& all, const std::uint8_t* is_pinned)
      : all_(all), is_pinned_(is_pinned) {}
  Vec4d operator[](int vertex) const { return is_pinned_[vertex] != 0 ? Vec4d{} : all_[vertex]; }
  double volume() const { return all_.volume(); }

 private:
  Accelerations all_;
  const std::uint8_t* is_pinned_;
};

/// As SoftAcceleration, for explicit_step.
class PinnedAcceleration {
 public:
  /// Refers to both.
  PinnedAcceleration(const SoftAcceleration& all, const Pins& pins) : all_(all), pins_(pins) {}
  PinnedAccelerations evaluate(const VertexArray& positions, const VertexArray& velocities) const {
    return {all_.evaluate(positions, velocities), pins_.is_pinned.data()};
  }

 private:
  const SoftAcceleration& all_;
  const Pins& pins_;
};

}  // namespace pneuma::sim
