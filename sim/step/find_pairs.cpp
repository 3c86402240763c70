#include <algorithm>
#include <tuple>

#include "sim/collision/approach.h"
#include "sim/collision/deep_pair.h"
#include "sim/collision/find_body_contacts.h"
#include "sim/collision/particles.h"
#include "sim/step/stages.h"

namespace pneuma::sim {
namespace {

/// Of soft bodies first, then of boxes. Soft bodies are in contact at a distance of twice the skin,
/// half of it each (ERRATA row 10). Boxes are in contact when something is inside them, or a
/// resting gap before.
void make_spheres(const World& world, StepWorkspace& workspace) {
  std::vector<BoundingSphere>& spheres = workspace.spheres;
  spheres.resize(world.soft.size());
  workspace.soft_bounds.resize(world.soft.size());
  const auto block = [&world, &workspace](int begin, int end, int) {
    for (int i = begin; i < end; ++i) {
      const VertexArray& positions = world.soft[at(i)].positions;
      const Bounds& around = workspace.soft_bounds[at(i)] = bounds(positions);
      workspace.spheres[at(i)] = bounding_sphere(positions, around, world.settings.skin_thickness);
    }
  };
  workspace.workers.for_blocks(static_cast<int>(world.soft.size()), block);
  for (const RigidBox& box : world.rigid) {
    const double gap = resting_lengths(box.size.minCoeff()).gap;
    spheres.push_back({box.position, 0.5 * box.size.norm() + gap});
  }
}

/// Particles begin to walk when bodies may touch within so many steps (or, if that is later, when
/// their spheres overlap). Bodies that are only neighbours cost no more than a look.
constexpr double steps_ahead = 4.0;

/// Leaves only the pairs of soft bodies that may touch.
void leave_out_separate(const World& world, StepWorkspace& workspace) {
  std::vector<BodyPair>& pairs = workspace.soft_pairs;
  workspace.touches.resize(pairs.size());
  const auto block = [&world, &workspace](int begin, int end, int) {
    const double reach = 2.0 * world.settings.skin_thickness;
    const double seconds = steps_ahead * time_step(world.settings);
    for (int i = begin; i < end; ++i) {
      const auto& [first, second] = workspace.soft_pairs[at(i)];
      const Vec3 direction =
          workspace.spheres[at(second)].centre - workspace.spheres[at(first)].centre;
      workspace.touches[at(i)] =
          may_touch(world.soft[at(first)], world.soft[at(second)], direction, reach, seconds);
    }
  };
  workspace.workers.for_blocks(static_cast<int>(pairs.size()), block);
  std::size_t left = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (workspace.touches[i]) pairs[left++] = pairs[i];
  }
  pairs.resize(left);
}

bool was_parting(const StepWorkspace& workspace, const BodyPair& pair) {
  const auto before = [](const PartingPair& known, const BodyPair& wanted) {
    return BodyPair{known.first, known.second} < wanted;
  };
  const std::vector<PartingPair>& known = workspace.parting_start;
  const auto place = std::lower_bound(known.begin(), known.end(), pair, before);
  return place != known.end() && BodyPair{place->first, place->second} == pair;
}

bool may_be_deep(const World& world, const StepWorkspace& workspace, const BodyPair& pair,
                 bool is_parting) {
  const std::vector<std::uint8_t>& filled = workspace.has_filled_centre;
  if (filled[at(pair.first)] == 0 || filled[at(pair.second)] == 0) return false;
  const double skin = world.settings.skin_thickness;  // in the spheres' radii
  const BoundingSphere& first = workspace.spheres[at(pair.first)];
  const BoundingSphere& second = workspace.spheres[at(pair.second)];
  const double reach = deep_reach(first.radius - skin, second.radius - skin, skin, is_parting);
  return (first.centre - second.centre).squaredNorm() < reach * reach;
}

/// A deep pair's surfaces are not looked at: they say nothing about the way out.
void take_out_deep_pairs(World& world, StepWorkspace& workspace) {
  world.parting.clear();
  workspace.deep_pairs.clear();
  std::erase_if(workspace.soft_pairs, [&](const BodyPair& pair) {
    const auto [first, second] = pair;
    const bool is_parting = was_parting(workspace, pair);
    if (!may_be_deep(world, workspace, pair, is_parting)) return false;
    const auto deep = find_deep_pair(world, first, second, is_parting, workspace.deep_pair);
    if (!deep) return false;
    workspace.deep_pairs.push_back(*deep);
    world.parting.push_back({first, second});
    return true;
  });
}

/// The particles of a pair, made when it meets for the first time.
ParticlePair& particles_of(World& world, const BodyPair& pair) {
  const auto before = [](const ParticlePair& known, const BodyPair& wanted) {
    return std::tie(known.first, known.second) < std::tie(wanted.first, wanted.second);
  };
  auto place = std::lower_bound(world.particles.begin(), world.particles.end(), pair, before);
  if (place == world.particles.end() || place->first != pair.first ||
      place->second != pair.second) {
    place = world.particles.insert(
        place, make_particles(pair.first, world.soft[at(pair.first)].mesh->topology, pair.second,
                              world.soft[at(pair.second)].mesh->topology, world.settings.particles,
                              world.settings.seed));
  }
  return *place;
}

/// Pairs that are near now, and no others, have particles that walk.
void mark_near(World& world, const std::vector<BodyPair>& soft_pairs) {
  for (ParticlePair& pair : world.particles) pair.near = false;
  for (const BodyPair& pair : soft_pairs) particles_of(world, pair).near = true;
}

}  // namespace

void find_pairs(World& world, StepWorkspace& workspace) {
  workspace.particles_start = world.particles;
  workspace.parting_start = world.parting;
  workspace.resting_start = world.resting_impulses;
  make_spheres(world, workspace);
  workspace.pair_finder.find(workspace.spheres, workspace.pairs);
  workspace.soft_pairs.clear();
  workspace.soft_rigid_pairs.clear();
  workspace.rigid_pairs.clear();
  const int soft = static_cast<int>(world.soft.size());
  for (const auto& [first, second] : workspace.pairs) {
    if (second < soft) {
      workspace.soft_pairs.push_back({first, second});
    } else if (first < soft) {
      workspace.soft_rigid_pairs.push_back({first, second - soft});
    } else {
      workspace.rigid_pairs.push_back({first - soft, second - soft});
    }
  }
  leave_out_separate(world, workspace);
  if (workspace.plan.runs(Stage::part_bodies)) take_out_deep_pairs(world, workspace);
  if (world.settings.soft_search == SoftSearch::particles) mark_near(world, workspace.soft_pairs);
}

}  // namespace pneuma::sim
