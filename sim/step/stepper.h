// Advances a world by one step: the list of stages, and the memory they share.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "sim/collision/contact.h"
#include "sim/step/stages/divergence.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Seconds spent in each stage since the stepper was made.
using StageTimes = std::array<double, stage_count>;

struct StepperOptions {
  int threads = 1;
  bool profile = false;       // measure StageTimes
  bool measure_work = false;  // measure Stepper::contact_work
  std::optional<Plan> plan;   // in place of the world's own: for tests
  /// Into which a step of the scene is divided, if each of these steps is such a part: it makes up
  /// as much less of what is too near.
  int parts = 1;
  /// Called with the world after each part of a step that contacts divide, or after the whole one
  /// if they do not: between these calls surfaces of swept contacts move along straight ways.
  std::function<void(const World&)> after_part = nullptr;
  /// Obstacles that are moved and keep their shape may be left in the world where they are until
  /// Stepper::place_obstacles, so that a step takes no longer for all their vertices. Whoever looks
  /// at them, copies the world or goes on with another stepper calls that first.
  bool may_leave_obstacles = false;
};

struct StepWorkspace;

/// Holds scratch memory for one world, no state: a new stepper on a copied world continues
/// identically. Results do not depend on the number of threads.
class Stepper {
 public:
  /// Throws std::invalid_argument for a body that the integrator cannot step (can_integrate).
  explicit Stepper(const World& world, StepperOptions options = {});
  ~Stepper();
  Stepper(Stepper&&) noexcept;
  Stepper& operator=(Stepper&&) noexcept;

  /// One step of the world this was made for. On divergence the world is left as the step found it:
  /// in its last valid state. Allocates nothing once the numbers of contacts, and
  /// of cells of the exact search, have peaked (but see vertex_matrix.h, find_divergence.h).
  [[nodiscard]] std::optional<Divergence> step(World& world);

  /// Brings obstacles to where they are and gives them their velocities, if any were left behind.
  void place_obstacles(World& world);

  const Plan& plan() const;
  /// The contacts that the last step found and resolved.
  std::span<const Contact> contacts() const;
  const StageTimes& stage_times() const;
  /// J, what the contacts of the last step have added to the energy of the bodies. Of swept
  /// contacts the work of each impulse at the mean velocity of where it acts, and of what shifted
  /// boxes; otherwise, and of bodies that only meet the ground, the change of energy by contacts. 0
  /// unless the options have measure_work.
  double contact_work() const;
  /// J, what the bodies that are moved have given to the energy of the bodies in the last step by
  /// pushing them: not part of contact_work, which takes both sides together.
  double driven_work() const;
  /// J, by which gas that came or went, or was heated, changed the energy that is reported for gas
  /// in the last step (GasFlow::work). What is left of the change of energy is of the motion.
  double gas_work() const;

 private:
  std::optional<Divergence> step_bodies(World& world);
  std::optional<Divergence> step_in_stages(World& world);
  std::optional<Divergence> step_on_ground(World& world);
  std::optional<Divergence> step_swept(World& world);
  std::optional<Divergence> step_by_potential(World& world);

  std::unique_ptr<StepWorkspace> workspace_;
};

}  // namespace pneuma::sim
