// The state of a simulation as plain data: bodies and settings, no algorithms.
// Units: metre, kilogram, second, kelvin, mole. Right-handed, +z up, ground at z = 0.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/world/body_spring.h"
#include "sim/world/rigid_box.h"
#include "sim/world/settings.h"
#include "sim/world/soft_body.h"

namespace pneuma::sim {

/// The impulse that held one point of a box in the last step, or would in a whole one if the last
/// was a part, from which the next step's solver starts. A stack of boxes stands only with a warm
/// start, so these are state (ERRATA row 59).
struct WarmStartImpulse {
  int first = 0;                // box
  int second = 0;               // box, or -1 for the ground
  Vec3 point = Vec3::Zero();    // where it acts, in the first box's own axes, m from its centre
  Vec3 impulse = Vec3::Zero();  // on the first box, N s; the second gets the opposite
  bool is_of_start = false;     // given at the start of the step (ERRATA row 67), not at its end
};

/// The same of two features of which one is on a soft body or a model: fewer iterations are needed.
struct FeatureImpulse {
  int first = 0;   // body, soft ones first
  int second = 0;  // body, or -1 for the ground
  Feature first_feature;
  Feature second_feature;
  Vec3 impulse = Vec3::Zero();  // on the first, N s
  bool is_of_start = false;
};

/// How far two features that friction holds have slipped so far: a little in every step, as springs
/// act within it and as what turns leads along an arc. The next step makes up for it, so these are
/// state (ERRATA row 67).
struct FrictionSlip {
  int first = 0;   // body, soft ones first
  int second = 0;  // body, or -1 for the ground
  Feature first_feature;
  Feature second_feature;
  Vec3 slip = Vec3::Zero();  // m, of the first against the second
};

/// The collision particles of one pair of soft bodies: the features they rest on, first < second.
/// They persist from step to step, so they are state (ERRATA row 41).
struct ParticlePair {
  int first = 0;
  int second = 0;
  std::vector<int> first_features;   // feature ids on `first`
  std::vector<int> second_features;  // feature ids on `second`
  bool near = false;                 // in the last step they might have touched
};

/// Two soft bodies that overlapped deeply and are not yet clear of each other, first < second
/// (sim/collision/overlapping_pair.h). State, because depenetration begins at one depth and ends at
/// another.
struct DepenetratingPair {
  int first = 0;
  int second = 0;
};

/// How long a body has been at rest (sim/response/fall_asleep.h). State, because bodies at rest
/// leave the step together, and wake together (sim/world/sleep.h).
struct BodyRest {
  int quiet_steps = 0;
  int group = -1;  // of bodies that sleep: the first of those that fell asleep with it; -1: awake
};

struct World {
  Settings settings;
  std::vector<SoftBody> soft;
  std::vector<RigidBox> rigid;
  std::vector<Valve> valves;            // between soft bodies
  std::vector<BodySpring> springs;      // likewise
  std::vector<ParticlePair> particles;  // pairs that have met, ordered by (first, second)
  // Of the last step. Without swept contacts those of each pair of boxes come one after the other.
  std::vector<WarmStartImpulse> warm_start_impulses;
  // Of the last step, where contacts are swept, ordered by what is in contact.
  std::vector<FeatureImpulse> feature_impulses;
  std::vector<FrictionSlip> friction_slips;
  std::vector<DepenetratingPair> depenetrating;  // ordered by (first, second)
  // J, per soft body, of the last steps: what bodies in contact may gain
  // (sim/step/swept/excess_work.h).
  std::vector<double> lost_energy;
  std::vector<BodyRest> rest;  // per body, soft ones first; empty before the first step
  // m, of all vertices of soft bodies, body by body: where they were when the body last was not at
  // rest. Likewise.
  std::vector<Vec3> quiet_places;
  std::int64_t steps = 0;  // done so far; time is steps / steps_per_second
};

/// Where bodies of both kinds are numbered, the soft ones come first, then the boxes.
inline int soft_count(const World& world) { return static_cast<int>(world.soft.size()); }
inline int soft_vertex_count(const World& world) {
  int sum = 0;
  for (const SoftBody& body : world.soft) sum += body.positions.size();
  return sum;
}
inline int body_count(const World& world) {
  return soft_count(world) + static_cast<int>(world.rigid.size());
}

/// Whether nothing changes how a body moves. How such bodies lie to each other and to the ground is
/// no matter of contacts.
inline bool is_kinematic(const World& world, int body) {
  const int box = body - soft_count(world);
  if (box >= 0) return world.rigid[at(box)].is_kinematic;
  return is_kinematic(world.soft[at(body)]);
}

inline double time(const World& world) {
  return static_cast<double>(world.steps) / world.settings.steps_per_second;
}

}  // namespace pneuma::sim
