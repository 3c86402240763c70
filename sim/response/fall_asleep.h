// Which bodies leave the step because they rest (ERRATA row 71).
#pragma once

#include <span>
#include <vector>

#include "sim/base/disjoint_sets.h"
#include "sim/collision/contact.h"
#include "sim/collision/packed_spheres.h"
#include "sim/response/motion_start.h"
#include "sim/world/sleep.h"

namespace pneuma::sim {

/// m, along the axis along which a body is longest, but at most 1: what speeds of rest are measured
/// by.
double length_of_rest(const World& world, int body);

/// Bodies near each other are an island, which falls asleep when it touches something and for half
/// a second none of its boxes has moved faster than Settings::sleep_speed, and for a second no
/// vertex of its soft bodies further than that speed leads in half of it; these, on average of
/// their vertices, were not faster than it or than what gravity gives in two steps. Of a body that
/// is shorter than a metre that speed is times its length in metres, and in gravity below 5 m/s^2
/// in proportion less.
/// Allocates nothing but in the first step.
class FallAsleep {
 public:
  explicit FallAsleep(const World& world);

  /// After each step, which began at `start`. Returns whether a body has been quiet for long
  /// enough.
  bool count_quiet_steps(World& world, const MotionStart& start);
  /// `pairs`: of bodies near each other, or near the ground (-1); `contacts`: those that press.
  /// Returns the energy of motion that fell asleep, J.
  double put_to_sleep(World& world, std::span<const BodyPair> pairs,
                      std::span<const Contact> contacts);

 private:
  void note_places(World& world, int soft) const;
  bool is_quiet(const World& world, const MotionStart& start, int body) const;
  void find_islands(const World& world, std::span<const BodyPair> pairs);
  void find_who_stays_awake(const World& world, std::span<const Contact> contacts);

  base::DisjointSets islands_;              // of bodies
  std::vector<int> first_vertices_;         // per soft body, among those of all
  std::vector<double> sizes_;               // per body, m, at most 1
  std::vector<std::uint8_t> never_sleeps_;  // per body
  std::vector<std::uint8_t> is_touched_;    // per island's first body
  std::vector<std::uint8_t> stays_awake_;   // per island's first body
};

/// Bodies that sleep with a velocity, which someone has given them, wake.
void wake_moving(World& world);

/// Whether nothing happens in a step: all bodies sleep or stand still.
bool is_at_rest(const World& world);

}  // namespace pneuma::sim
