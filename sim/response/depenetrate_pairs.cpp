#include "sim/response/depenetrate_pairs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/mesh/measure.h"

namespace pneuma::sim {
namespace {

using Body = DepenetrationScratch::Body;

/// Damped Jacobi iterations: the fraction of what would clear a pair that one iteration adds to the
/// ways of its bodies; all pairs see the ways before the iteration. A body among six that lie
/// around it is asked by each of them: with a fraction above a third it would be sent too far, and
/// back, and farther.
constexpr double jacobi_fraction = 0.25;
constexpr int jacobi_iterations = 8;

/// Fraction of the distance that clears a pair: centres nearer than this say little about the way.
constexpr double near_fraction = 0.125;

/// Where a body would lie among others that start at one point: seeds of a sunflower, the golden
/// angle apart, which fill a disc evenly.
Vec3 seed_position(int body) {
  const double angle = body * std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double radius = std::sqrt(body + 0.5);
  return {radius * std::cos(angle), radius * std::sin(angle), 0.0};
}

/// Unit, from the first to the second body of a pair. The nearer their centres are, the more their
/// numbers decide it: but it never leads them through each other.
Vec3 way_apart(const OverlappingPair& pair, const Vec3& between) {
  const double distance = between.norm();
  const Vec3 apart = distance > 0.0 ? Vec3(between / distance) : Vec3::Zero();
  const double given_fraction = 1.0 - distance / (near_fraction * pair.clear);
  if (!(given_fraction > 0.0)) return apart;
  Vec3 given = (seed_position(pair.second) - seed_position(pair.first)).normalized();
  given -= 2.0 * std::min(0.0, given.dot(apart)) * apart;
  return (given_fraction * given + (1.0 - given_fraction) * apart).normalized();
}

void gather(const World& world, std::span<const OverlappingPair> pairs, std::vector<Body>& bodies) {
  bodies.assign(world.soft.size(), {});
  for (const OverlappingPair& pair : pairs) {
    for (const int i : {pair.first, pair.second}) {
      Body& entry = bodies[at(i)];
      if (entry.overlaps) continue;
      const SoftBody& body = world.soft[at(i)];
      entry.overlaps = true;
      entry.inverse_mass = 1.0 / (body.material.vertex_mass * body.positions.size());
      entry.velocity = entry.start_velocity = mean(body.velocities);
    }
  }
}

/// Asks of both bodies what would clear the pair, from where their ways lead so far.
void ask(const OverlappingPair& pair, bool along_ground, Body& first, Body& second) {
  Vec3 between = pair.between + second.way - first.way;
  // |between + length apart|^2 is to become what clears them, squared.
  const double missing = pair.clear * pair.clear - between.squaredNorm();
  if (!(missing > 0.0)) return;
  if (along_ground) between.z() = 0.0;
  const Vec3 apart = way_apart(pair, between);
  const double along = between.dot(apart);
  const double length = std::sqrt(along * along + missing) - along;
  const Vec3 moment = length / (first.inverse_mass + second.inverse_mass) * apart;
  first.asked -= first.inverse_mass * moment;
  second.asked += second.inverse_mass * moment;
}

void find_ways(std::span<const OverlappingPair> pairs, bool along_ground,
               std::vector<Body>& bodies) {
  for (int i = 0; i < jacobi_iterations; ++i) {
    for (Body& body : bodies) body.asked.setZero();
    for (const OverlappingPair& pair : pairs) {
      ask(pair, along_ground, bodies[at(pair.first)], bodies[at(pair.second)]);
    }
    for (Body& body : bodies) body.way += jacobi_fraction * body.asked;
  }
}

void stop_approach(const OverlappingPair& pair, Body& first, Body& second) {
  const double distance = pair.between.norm();
  if (!(distance > 0.0)) return;
  const Vec3 line = pair.between / distance;
  const double approach = (first.velocity - second.velocity).dot(line);
  if (!(approach > 0.0)) return;
  const Vec3 impulse = approach / (first.inverse_mass + second.inverse_mass) * line;
  first.velocity -= first.inverse_mass * impulse;
  second.velocity += second.inverse_mass * impulse;
}

/// All bodies do the same part of their ways, or their common centre of mass would move: what the
/// one with the longest, for its size, may do.
double max_part(std::span<const Body> bodies, std::span<const BoundingSphere> spheres,
                double radii) {
  double part = 1.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double way = bodies[i].way.norm(), limit = radii * spheres[i].radius;
    if (way > limit) part = std::min(part, limit / way);
  }
  return part;
}

}  // namespace

void depenetrate_pairs(World& world, std::span<const OverlappingPair> pairs, double radii,
                       std::span<const BoundingSphere> spheres, DepenetrationScratch& scratch) {
  std::vector<Body>& bodies = scratch.bodies;
  gather(world, pairs, bodies);
  for (const OverlappingPair& pair : pairs) {
    stop_approach(pair, bodies[at(pair.first)], bodies[at(pair.second)]);
  }
  find_ways(pairs, world.settings.ground.has_value(), bodies);
  const double part = max_part(bodies, spheres, radii);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].overlaps) continue;
    SoftBody& body = world.soft[i];
    const Vec3 change = bodies[i].velocity - bodies[i].start_velocity;
    for (int v = 0; v < body.positions.size(); ++v) {
      body.positions[v] += part * bodies[i].way;
      body.velocities[v] += change;
    }
  }
}

}  // namespace pneuma::sim
