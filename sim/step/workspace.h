// The memory that the stages of a step share: scratch and this step's contacts. Private to
// sim/step.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sim/collision/deep_pair.h"
#include "sim/collision/find_body_contacts.h"
#include "sim/collision/find_exact.h"
#include "sim/collision/find_soft_soft.h"
#include "sim/collision/pair_finder.h"
#include "sim/collision/particles.h"
#include "sim/response/contact_impulse.h"
#include "sim/response/contact_islands.h"
#include "sim/response/part_deep_pairs.h"
#include "sim/soft/integrators.h"
#include "sim/step/stepper.h"
#include "sim/step/workers.h"

namespace pneuma::sim {

/// What integrate_soft needs per thread: one scratch per distinct mesh, shared by all bodies of it.
struct SoftScratch {
  std::vector<std::vector<IntegratorScratch>> per_thread;  // [thread][mesh]
  std::vector<int> mesh_of_body;
};

/// The motion of a box as the step found it.
struct RigidStart {
  Vec3 position = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
};

/// Of the soft body that boxes were last tested against.
struct SoftColumns {
  int body = -1;
  SurfaceColumns surface;
};

struct StepWorkspace {
  StepWorkspace(const World& world, StepperOptions options);

  StepperOptions options;
  Plan plan;
  Workers workers;
  SoftScratch soft;
  std::vector<SoftState> soft_start;                    // per body, as the step found it
  std::vector<RigidStart> rigid_start;                  // per box
  std::vector<ParticlePair> particles_start;            // of the world
  std::vector<PartingPair> parting_start;               // of the world
  std::vector<RestingImpulse> resting_start;            // of the world
  std::vector<std::optional<Divergence>> soft_outcome;  // per body
  std::vector<Bounds> soft_bounds;                      // per body
  std::vector<BoundingSphere> spheres;                  // of the soft bodies, then of the boxes
  PairFinder pair_finder;
  std::vector<BodyPair> pairs;                  // of spheres
  std::vector<BodyPair> soft_pairs;             // of soft bodies that may touch, but the deep ones
  std::vector<std::uint8_t> touches;            // whether each of them may
  std::vector<BodyPair> soft_rigid_pairs;       // first: soft body, second: box
  std::vector<BodyPair> rigid_pairs;            // of boxes
  std::vector<std::uint8_t> has_filled_centre;  // per soft body, if the plan has part_bodies
  std::vector<DeepPair> deep_pairs;
  DeepPairScratch deep_pair;
  PartingScratch parting;
  std::vector<ParticleScratch> particles;   // per thread
  std::vector<SoftSoftScratch> soft_soft;   // per thread
  std::vector<ExactScratch> exact;          // per thread
  std::vector<PlacedBox> boxes;             // of the world
  std::vector<SoftColumns> columns;         // per thread
  std::vector<std::vector<Contact>> found;  // per thread but the first, which fills `contacts`
  std::vector<Contact> contacts;
  std::vector<VertexArray> before_contacts;  // positions per soft body, of implicit integrators
  std::vector<BoxMass> box_masses;
  ContactIslands islands;
  // At least as many as the islands have contacts, in their order.
  std::vector<ContactImpulse> impulses;
  std::vector<int> impulse_number;  // per contact in an island, into impulses
  std::vector<double> pair_work;    // J, by the contacts of each pair of bodies in an island
  StageTimes stage_times{};
};

}  // namespace pneuma::sim
