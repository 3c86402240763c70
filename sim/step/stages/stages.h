// The stages of a step, in the order of the Stage enum (ERRATA row 37). A stage reads what it takes
// by const reference and writes what it takes by reference: first the world, then what stages hand
// to each other, then its own memory, of which nothing lasts from step to step. Private to
// sim/step.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/base/workers.h"
#include "sim/step/stages/stage_memory.h"

namespace pneuma::sim {

/// Integrates the forces on every soft body (sections 3.1, 3.2), and keeps what it started from.
/// Returns the first body's failure.
std::optional<Divergence> integrate_soft(World& world, std::vector<SoftState>& start,
                                         IntegrateSoftMemory& memory, base::Workers& workers);

/// The same for one body from another start than it has, by one of the threads.
std::optional<Divergence> integrate_soft_again(World& world, int body, const SoftState& start,
                                               IntegrateSoftMemory& memory, int thread);

/// The same for bodies that springs join, from the states of all soft bodies.
std::optional<Divergence> integrate_group_again(World& world, JoinedStep& group,
                                                std::span<const SoftState> start,
                                                IntegrateSoftMemory& memory, int thread);

/// Over the last step pinned vertices keep the velocities that they had at its start.
void hold_pins(World& world, std::span<const SoftState> start, const IntegrateSoftMemory& memory);

/// Moves every box freely (4.1), and keeps what it started from. Returns the first box's failure.
std::optional<Divergence> integrate_rigid(World& world, std::vector<RigidState>& start);
std::optional<Divergence> integrate_rigid_again(World& world, int box, const RigidState& start);

/// Finds the bodies whose bounding spheres overlap (5.1), of soft ones those that no plane
/// separates. Of these it sets those aside that overlap deeply, if `plan` has depenetrate, and
/// gives the others their particles, if they are searched by them.
void broad_phase(World& world, const Plan& plan, PairStart& start, NearBodies& near_bodies,
                 BroadPhaseMemory& memory, base::Workers& workers);

/// Lets the particles of all near pairs walk (5.2.1).
void move_particles(World& world, const NearBodies& near_bodies, MoveParticlesMemory& memory,
                    base::Workers& workers);

/// Finds the contacts, kind by kind and body by body, so that their order is fixed (5.2).
void find_contacts(const World& world, const Plan& plan, const NearBodies& near_bodies,
                   std::vector<Contact>& contacts, FindContactsMemory& memory,
                   base::Workers& workers);

/// Applies impulses and friction and separates bodies (5.3), island by island; the contacts get
/// their impulses. Returns the first body that this left with a value that is not finite, with a
/// vertex faster than max_speed (find_divergence.h), or, of a body that holds gas, with a volume
/// that is not above zero.
std::optional<Divergence> resolve_contacts(World& world, const MotionStart& start,
                                           std::span<Contact> contacts,
                                           ResolveContactsMemory& memory, base::Workers& workers);

/// Moves soft bodies apart that overlap deeply (sim/response/depenetrate_pairs.h). Returns the
/// first body that this moved by what is not a finite number.
std::optional<Divergence> depenetrate(World& world, const NearBodies& near_bodies,
                                      DepenetrateMemory& memory);

}  // namespace pneuma::sim
