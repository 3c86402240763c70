// The impact of two boxes, followed along its impulse.
//
// What friction does in an impact depends on the way there: where the sliding comes to its end, or
// turns, the impulse so far stays as it was. Newton's ratio of speeds can then create energy, and
// Coulomb's cone about the whole impulse lets friction pull as hard as it can in the last direction
// alone. So the impulse grows bit by bit, each within Coulomb's cone about what came before (Routh
// 1905; Keller, "Impact with friction", 1986), until the boxes no longer approach; then on until
// the normal impulses have returned restitution^2 of the work that they took (Stronge, "Rigid body
// collisions with friction", 1990).
#pragma once

#include <span>
#include <vector>

#include "sim/swept/conjugate_iterations.h"

namespace pneuma::sim {

/// A point in which the boxes meet, or may meet.
struct ImpactPoint {
  SweptImpulse* impulse = nullptr;
  Vec3 velocity = Vec3::Zero();  // m/s, of the first side against the second, as impulses began
  double speed = 0.0;            // m/s, of that along the normal and of the drift
  double approach = 0.0;         // m/s, with which it is hit; 0: it is not, and does not bounce
  double parting = 0.0;          // m/s, at which the sides part at least, of what is not hit
  Vec3 at = Vec3::Zero();        // m, where it is
  Vec3 driven = Vec3::Zero();    // m/s, of a second side that is moved
};

class ImpactPath {
 public:
  /// Replaces the impulses, also what they were started from; solves for velocities to
  /// `max_tolerance` (m/s) or better. Allocates nothing once the number of points has peaked.
  void follow(std::span<const ImpactPoint> points, double restitution, double max_tolerance);
  /// The same of points that do not rub: each by itself parts with `restitution` times the speed
  /// with which it is hit, as Newton has it, which then adds no energy.
  void part_at_once(std::span<const ImpactPoint> points, double restitution, double max_tolerance);

 private:
  /// Of one point.
  struct State {
    double speed = 0.0;   // m/s, along the normal, before the part
    double normal = 0.0;  // N s, of all parts
    Vec3 friction = Vec3::Zero();
    Vec3 given = Vec3::Zero();  // N s, before the part, by the count of the impulse
  };

  void begin(std::span<const ImpactPoint> points);
  double add_part(std::span<const ImpactPoint> points, double share, double tolerance);
  void shorten_part(std::span<const ImpactPoint> points, double work);
  void keep_part(std::span<const ImpactPoint> points);
  void end(std::span<const ImpactPoint> points);

  std::vector<State> states_;
  std::vector<SweptImpulse*> impulses_;
  ConjugateIterations iterations_;
};

}  // namespace pneuma::sim
