// What contacts have added to the energy of islands, these give up again. Private to sim/step.
#pragma once

#include "sim/response/motion_start.h"
#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

struct Excess {
  double taken = 0.0;  // J
  double left = 0.0;   // J, that an island has no motion to take from, if it is more than rounding
  int island = -1;     // that has most of it left
};

/// The impulses at both ends of a step do no work together if what presses bodies on each other is
/// the same at both ends. Where it grows they take energy and where it falls they add some, of
/// second order in the step: an island whose contacts have added energy gives it up again from the
/// motion of its soft bodies that is not that of a rigid body, and then from that of its bodies
/// against each other, so that momentum and angular momentum stay as they are. An island of boxes
/// that the ground or a body at rest bears, which changes these anyway, gives up from all motion.
///
/// Of an island that is so held and has soft bodies, springs that are damped between the impulses
/// at both ends may have taken the work already, and steps may gain and lose energy alternately.
/// Were all work taken, no motion might be left. So it gives up what its energy has grown by, less
/// what it lost, by whatever, in the step before and nine tenths as much of each step before that
/// (World::lost_energy): its energy may rise by what it lost in some ten steps, and no higher than
/// it was. Balls of a few joules between plates, at the coarsest steps that they bear, were seen to
/// rise by up to 2 % of their motion. For the rest of the work only vibrations pay, by a fraction
/// of theirs, and motions of its bodies against each other that are as slow as at rest.
///
/// Not of implicit steps, which damp what impulses at their start move.
///
/// `start`: of the step. The velocities must be those of the end, solved for to `tolerance` (m/s,
/// of a whole step), and the memory know the work of its islands.
Excess take_back_excess_work(World& world, const MotionStart& start, SweptMemory& memory,
                             double tolerance);

}  // namespace pneuma::sim
