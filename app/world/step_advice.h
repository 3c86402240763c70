// How long a body's steps may be, and what to do when they are longer.
#pragma once

#include <string>
#include <vector>

#include "sim/world/world.h"

namespace pneuma::app {

struct StepAdvice {
  std::string body;
  int count = 1;              // of bodies like it
  double step = 0.0;          // s, of the scene
  double limit = 0.0;         // s, of the body's small motions by the scene's integrator
  double safe = 0.0;          // s, less than the limit by a margin
  int steps_per_second = 0;   // to try again with, a multiple of the scene's; 0: none is allowed
  std::string why;            // "k = 1e+06 N/m, n = 1 mol, vertex_mass = 0.35 kg with rk4"
  bool implicit_can = false;  // take over
  bool of_contact = false;    // the limit
  bool of_springs = false;    // between bodies: the limit, which implicit integrators have too

  bool too_long() const { return step > limit; }
  bool is_safe() const { return step <= safe; }
};

/// Of a soft body of the world as it is, and as it will be when its gas has blown it up
/// (stability_limit.h), with the springs on it. Safe are nine tenths of the limit for a body alone,
/// and less of it for bodies that may lie on each other, whose contacts shake them nearer to it,
/// and beside boxes, which divide steps; where they may touch, rk8's are no longer than rk4's. To
/// try again with: safe steps; where they already are, a quarter as long.
StepAdvice step_advice(const sim::World& world, const sim::SoftBody& body);

/// The same of a world in which something diverged: where contact is a potential and bodies touch,
/// with the limit of all of them together (sim/potential/world_vibration.h), if that is less.
StepAdvice step_advice_in_contact(const sim::World& world, const sim::SoftBody& body);

/// "a step of 0.00185 s for k = 90000 N/m ... with rk4 (--set
/// simulation.steps_per_second=540), or --set simulation.integrator=implicit_euler".
std::string remedy(const StepAdvice& advice);

/// Of one body for each mesh and material, and of all others with springs to other bodies.
std::vector<StepAdvice> step_advices(const sim::World& world);

/// A line about steps that are too long.
std::string step_warning(const StepAdvice& advice);

}  // namespace pneuma::app
