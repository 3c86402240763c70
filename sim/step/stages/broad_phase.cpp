#include <algorithm>
#include <tuple>

#include "sim/collision/find_body_contacts.h"
#include "sim/collision/overlapping_pair.h"
#include "sim/collision/particles.h"
#include "sim/collision/separating_plane.h"
#include "sim/step/stages/stages.h"

namespace pneuma::sim {
namespace {

/// Of soft bodies first, then of boxes. Soft bodies are in contact at a distance of twice the skin,
/// half of it each (ERRATA row 10). Boxes are in contact when something is inside them or
/// within the speculative margin.
void make_spheres(const World& world, std::vector<BoundingSphere>& spheres,
                  std::vector<Bounds>& soft_bounds, base::Workers& workers) {
  const bool as_printed = is_as_printed(world.settings);
  spheres.resize(world.soft.size());
  soft_bounds.resize(world.soft.size());
  const auto block = [&](int begin, int end, int) {
    for (int i = begin; i < end; ++i) {
      const VertexArray& positions = world.soft[at(i)].positions;
      const Bounds& around = soft_bounds[at(i)] = bounds(positions);
      spheres[at(i)] = as_printed
                           ? printed_bounding_sphere(around)
                           : bounding_sphere(positions, around, world.settings.skin_thickness);
    }
  };
  workers.for_blocks(static_cast<int>(world.soft.size()), block);
  for (const RigidBox& box : world.rigid) {
    const double margin = as_printed ? 0.0 : resting_lengths(box.size.minCoeff()).margin;
    spheres.push_back({box.position, 0.5 * box.size.norm() + margin});
  }
}

/// Particles begin to walk when bodies may touch within so many steps (or, if that is later, when
/// their spheres overlap). Bodies that are only neighbours cost no more than the separating-plane
/// test (ERRATA row 39).
constexpr double steps_ahead = 4.0;

/// Leaves only the pairs of soft bodies that no plane separates.
void leave_out_separate(const World& world, NearBodies& near_bodies,
                        std::vector<std::uint8_t>& is_separate, base::Workers& workers) {
  std::vector<BodyPair>& pairs = near_bodies.soft_pairs;
  is_separate.resize(pairs.size());
  const auto block = [&](int begin, int end, int) {
    const double reach = 2.0 * world.settings.skin_thickness;
    const double seconds = steps_ahead * time_step(world.settings);
    for (int i = begin; i < end; ++i) {
      const auto& [first, second] = pairs[at(i)];
      const Vec3 direction =
          near_bodies.spheres[at(second)].centre - near_bodies.spheres[at(first)].centre;
      is_separate[at(i)] = has_separating_plane(world.soft[at(first)], world.soft[at(second)],
                                                direction, reach, seconds);
    }
  };
  workers.for_blocks(static_cast<int>(pairs.size()), block);
  std::size_t left = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!is_separate[i]) pairs[left++] = pairs[i];
  }
  pairs.resize(left);
}

bool was_depenetrating(const std::vector<DepenetratingPair>& known, const BodyPair& pair) {
  const auto before = [](const DepenetratingPair& one, const BodyPair& wanted) {
    return BodyPair{one.first, one.second} < wanted;
  };
  const auto found = std::lower_bound(known.begin(), known.end(), pair, before);
  return found != known.end() && BodyPair{found->first, found->second} == pair;
}

bool may_overlap(const World& world, std::span<const BoundingSphere> spheres,
                 const std::vector<std::uint8_t>& filled, const BodyPair& pair,
                 bool is_depenetrating) {
  if (filled[at(pair.first)] == 0 || filled[at(pair.second)] == 0) return false;
  const double skin = world.settings.skin_thickness;  // in the spheres' radii
  const BoundingSphere& first = spheres[at(pair.first)];
  const BoundingSphere& second = spheres[at(pair.second)];
  const double reach =
      overlap_reach(first.radius - skin, second.radius - skin, skin, is_depenetrating);
  return (first.centre - second.centre).squaredNorm() < reach * reach;
}

/// The surfaces of a pair that overlaps deeply are not looked at: they say nothing about the way
/// out.
void set_overlapping_aside(World& world, const PairStart& start, NearBodies& near_bodies,
                           BroadPhaseMemory& memory) {
  world.depenetrating.clear();
  near_bodies.overlapping_pairs.clear();
  std::erase_if(near_bodies.soft_pairs, [&](const BodyPair& pair) {
    const auto [first, second] = pair;
    const bool is_depenetrating = was_depenetrating(start.depenetrating, pair);
    if (!may_overlap(world, near_bodies.spheres, memory.has_filled_centre, pair,
                     is_depenetrating)) {
      return false;
    }
    const auto overlapping =
        find_overlapping_pair(world, first, second, is_depenetrating, memory.overlapping_pair);
    if (!overlapping) return false;
    near_bodies.overlapping_pairs.push_back(*overlapping);
    world.depenetrating.push_back({first, second});
    return true;
  });
}

/// The particles of a pair, made when it meets for the first time.
ParticlePair& particles_of(World& world, const BodyPair& pair) {
  const auto before = [](const ParticlePair& known, const BodyPair& wanted) {
    return std::tie(known.first, known.second) < std::tie(wanted.first, wanted.second);
  };
  auto found = std::lower_bound(world.particles.begin(), world.particles.end(), pair, before);
  if (found == world.particles.end() || found->first != pair.first ||
      found->second != pair.second) {
    found = world.particles.insert(
        found, make_particles(pair.first, world.soft[at(pair.first)].mesh->topology, pair.second,
                              world.soft[at(pair.second)].mesh->topology, world.settings.particles,
                              world.settings.seed));
  }
  return *found;
}

/// Pairs that are near now, and no others, have particles that walk (ERRATA row 41).
void mark_near(World& world, const std::vector<BodyPair>& soft_pairs) {
  for (ParticlePair& pair : world.particles) pair.near = false;
  for (const BodyPair& pair : soft_pairs) particles_of(world, pair).near = true;
}

/// `soft`: the number of soft bodies, which come first.
void sort_by_kind(std::span<const BodyPair> pairs, int soft, NearBodies& near_bodies) {
  near_bodies.soft_pairs.clear();
  near_bodies.soft_rigid_pairs.clear();
  near_bodies.rigid_pairs.clear();
  for (const auto& [first, second] : pairs) {
    if (second < soft) {
      near_bodies.soft_pairs.push_back({first, second});
    } else if (first < soft) {
      near_bodies.soft_rigid_pairs.push_back({first, second - soft});
    } else {
      near_bodies.rigid_pairs.push_back({first - soft, second - soft});
    }
  }
}

}  // namespace

void broad_phase(World& world, const Plan& plan, PairStart& start, NearBodies& near_bodies,
                 BroadPhaseMemory& memory, base::Workers& workers) {
  start.particles = world.particles;
  start.depenetrating = world.depenetrating;
  start.warm_start_impulses = world.warm_start_impulses;
  make_spheres(world, near_bodies.spheres, near_bodies.soft_bounds, workers);
  memory.sweep_and_prune.find(near_bodies.spheres, memory.pairs);
  sort_by_kind(memory.pairs, static_cast<int>(world.soft.size()), near_bodies);
  if (!is_as_printed(world.settings)) {
    leave_out_separate(world, near_bodies, memory.is_separate, workers);
  }
  if (plan.runs(Stage::depenetrate)) set_overlapping_aside(world, start, near_bodies, memory);
  if (world.settings.soft_search == SoftSearch::particles) mark_near(world, near_bodies.soft_pairs);
}

}  // namespace pneuma::sim
