#include <algorithm>
#include <tuple>

#include "sim/collision/approach.h"
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
  const auto block = [&world, &workspace](int begin, int end, int) {
    for (int i = begin; i < end; ++i) {
      workspace.spheres[at(i)] =
          bounding_sphere(world.soft[at(i)].positions, world.settings.skin_thickness);
    }
  };
  workspace.workers.for_blocks(static_cast<int>(world.soft.size()), block);
  for (const RigidBox& box : world.rigid) {
    const double gap = resting_lengths(box.size.minCoeff()).gap;
    spheres.push_back({box.position, 0.5 * box.size.norm() + gap});
  }
}

/// So many steps before bodies touch their particles begin to walk. Bodies that are only neighbours
/// cost no more than a look.
constexpr double steps_ahead = 4.0;

/// Leaves only the pairs of soft bodies that may touch.
void leave_out_parted(const World& world, StepWorkspace& workspace) {
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
  leave_out_parted(world, workspace);
  if (world.settings.soft_search == SoftSearch::particles) mark_near(world, workspace.soft_pairs);
}

}  // namespace pneuma::sim
