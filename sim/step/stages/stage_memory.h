// The memory of a step: what stages hand to each other, and one struct of scratch for each stage
// that needs any. Private to sim/step.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/collision/find_body_contacts.h"
#include "sim/collision/find_exact.h"
#include "sim/collision/find_soft_soft.h"
#include "sim/collision/overlapping_pair.h"
#include "sim/collision/particles.h"
#include "sim/collision/sweep_and_prune.h"
#include "sim/joints/joined_step.h"
#include "sim/response/contact_impulse.h"
#include "sim/response/contact_islands.h"
#include "sim/response/depenetrate_pairs.h"
#include "sim/response/motion_start.h"
#include "sim/soft/integrators.h"
#include "sim/step/stages/divergence.h"

namespace pneuma::sim {

/// What the world knew of its pairs of bodies when the step found it. broad_phase writes it, and a
/// step that fails is taken back to it.
struct PairStart {
  std::vector<ParticlePair> particles;
  std::vector<DepenetratingPair> depenetrating;
  std::vector<WarmStartImpulse> warm_start_impulses;
};

/// The result of broad_phase: which bodies are near each other.
struct NearBodies {
  std::vector<BoundingSphere> spheres;     // of the soft bodies, then of the boxes
  std::vector<Bounds> soft_bounds;         // per soft body
  std::vector<BodyPair> soft_pairs;        // those that no plane separates and that do not overlap
  std::vector<BodyPair> soft_rigid_pairs;  // first: soft body, second: box
  std::vector<BodyPair> rigid_pairs;       // of boxes
  std::vector<OverlappingPair> overlapping_pairs;  // of soft bodies: for depenetrate
};

struct IntegrateSoftMemory {
  IntegrateSoftMemory(const World& world, int threads);

  // One scratch per thread and distinct mesh, shared by all bodies of the mesh.
  std::vector<std::vector<IntegratorScratch>> scratch;  // [thread][mesh]
  int alone = 0;  // soft bodies; 0 where springs join some: all are in groups then
  std::vector<JoinedStep> groups;
  std::vector<int> mesh_of_body;
  /// Per body: an obstacle that the step leaves where it is, and that is moved after it.
  std::vector<std::uint8_t> is_driven;
  std::vector<std::optional<Divergence>> outcomes;  // per body
};

struct BroadPhaseMemory {
  /// `depenetrates`: whether the plan has that stage.
  BroadPhaseMemory(const World& world, bool depenetrates);

  SweepAndPrune sweep_and_prune;
  std::vector<BodyPair> pairs;                  // of spheres
  std::vector<std::uint8_t> is_separate;        // per soft pair: whether a plane separates it
  std::vector<std::uint8_t> has_filled_centre;  // per soft body; empty if nothing depenetrates
  OverlappingPairScratch overlapping_pair;
};

struct MoveParticlesMemory {
  std::vector<ParticleScratch> scratch;  // per thread
};

struct FindContactsMemory {
  explicit FindContactsMemory(int threads);

  /// The soft body that boxes were last tested against.
  struct SoftColumns {
    int body = -1;
    SurfaceColumns surface;
  };
  std::vector<PlacedBox> boxes;             // of the world
  std::vector<SoftSoftScratch> soft_soft;   // per thread
  std::vector<ExactScratch> exact;          // per thread
  std::vector<SoftColumns> columns;         // per thread
  std::vector<std::vector<Contact>> found;  // per thread but the first, which fills the result
};

struct ResolveContactsMemory {
  explicit ResolveContactsMemory(const World& world);

  std::vector<VertexArray> before_contacts;  // positions per soft body, of implicit integrators
  std::vector<Vec3> box_positions;  // as contacts found them, where they are resolved as printed
  std::vector<BoxMass> box_masses;
  ContactIslands islands;
  // At least as many as the islands have contacts, in their order.
  std::vector<ContactImpulse> impulses;
  std::vector<int> impulse_number;  // per contact in an island, into impulses
  std::vector<double> pair_work;    // J, by the contacts of each pair of bodies in an island
  std::vector<std::optional<Divergence>> outcomes;  // per soft body
};

struct DepenetrateMemory {
  DepenetrationScratch scratch;
};

}  // namespace pneuma::sim
