#include "app/check/run_statistics.h"

#include <algorithm>

#include "app/host/interrupt.h"
#include "app/record/two_bodies.h"
#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/overlap.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

double volume(const sim::SoftBody& body) {
  return sim::volume(body.mesh->topology, body.positions);
}

double fastest_point(const sim::World& world) {
  double speed = 0.0;
  for (const sim::SoftBody& body : world.soft) {
    for (int v = 0; v < body.velocities.size(); ++v) {
      speed = std::max(speed, sim::Vec3(body.velocities[v]).norm());
    }
  }
  for (const sim::RigidBox& box : world.rigid) {
    // No point of a box is farther from its axis of rotation than half the diagonal.
    const double rim = box.angular_velocity.norm() * 0.5 * box.size.norm();
    speed = std::max(speed, box.velocity.norm() + rim);
  }
  return speed;
}

/// Gathers the statistics while a run goes on.
class Observer {
 public:
  Observer(const sim::World& start, std::int64_t all_steps)
      : all_steps_(all_steps),
        last_energy_(sim::energy(start).total()),
        least_energy_(last_energy_),
        greatest_energy_(last_energy_) {
    result_.energy_start = sim::energy(start);
    result_.momentum_start = sim::momentum(start);
    result_.start_penetration = sim::max_penetration(start);
    result_.penetration = {result_.start_penetration, sim::time(start)};
    result_.free = !start.settings.ground && start.settings.gravity.isZero();
    look_for_crossings(start);
    for (const sim::SoftBody& body : start.soft) {
      const double now = volume(body);
      result_.volumes.push_back({body.name, now, now, now});
    }
  }

  void after_step(const sim::World& world, const sim::Stepper& stepper) {
    result_.contacts.add(stepper.contacts());
    if (2 * world.steps > all_steps_) result_.settled_contacts.add(stepper.contacts());
  }

  void after_frame(const sim::World& world) {
    const double now = sim::energy(world).total();
    const double rise = now - last_energy_;
    result_.energy_rises += std::max(0.0, rise);
    if (rise > result_.energy_rise.value) result_.energy_rise = {rise, sim::time(world)};
    last_energy_ = now;
    least_energy_ = std::min(least_energy_, now);
    greatest_energy_ = std::max(greatest_energy_, now);
    const double depth = sim::max_penetration(world);
    if (depth > result_.penetration.value) result_.penetration = {depth, sim::time(world)};
    if (2 * world.steps > all_steps_) {
      result_.settled_penetration = std::max(result_.settled_penetration, depth);
    }
    look_for_crossings(world);
    for (std::size_t b = 0; b < world.soft.size(); ++b) {
      VolumeRange& range = result_.volumes[b];
      range.least = std::min(range.least, volume(world.soft[b]));
      range.greatest = std::max(range.greatest, volume(world.soft[b]));
    }
  }

  RunStatistics finish(const sim::World& world) {
    result_.steps = world.steps;
    result_.seconds = sim::time(world);
    result_.energy_end = sim::energy(world);
    result_.energy_span = greatest_energy_ - least_energy_;
    result_.momentum_end = sim::momentum(world);
    result_.end_speed = fastest_point(world);
    result_.state_hash = sim::state_hash(world);
    for (const sim::Overlap& overlap : sim::overlaps(world)) {
      if (overlap.depth <= result_.end_overlap) continue;
      result_.end_overlap = overlap.depth;
      result_.end_overlap_bodies = two_bodies(world, overlap.first, overlap.second);
    }
    return std::move(result_);
  }

  void diverged(std::string how) { result_.divergence = std::move(how); }

 private:
  void look_for_crossings(const sim::World& world) {
    const sim::Crossings found = sim::crossings(world);
    ++result_.frames;
    const auto add = [&](CrossingStatistics& statistics, int edges, bool of_one_body) {
      if (edges == 0) return;
      ++statistics.frames;
      if (edges <= statistics.edges.value) return;
      statistics.edges = {static_cast<double>(edges), sim::time(world)};
      const auto pair = std::ranges::find_if(found.pairs, [&](const sim::CrossingPair& crossing) {
        return (crossing.first == crossing.second) == of_one_body;
      });
      statistics.first_bodies = two_bodies(world, pair->first, pair->second);
    };
    add(result_.crossings, found.between_bodies, false);
    add(result_.self_crossings, found.within_bodies, true);
  }

  RunStatistics result_;
  std::int64_t all_steps_;
  double last_energy_;
  double least_energy_;
  double greatest_energy_;
};

}  // namespace

RunStatistics run_statistics(const scenes::Scene& scene, int threads) {
  sim::World world = build_world(scene);
  sim::Stepper stepper(world, {.threads = threads, .plan = {}});
  const int steps_per_frame = scenes::steps_per_frame(scene);
  const std::int64_t all_steps = scenes::frame_count(scene) * steps_per_frame;
  Observer observer(world, all_steps);

  while (world.steps < all_steps) {
    throw_if_interrupted();
    if (const auto divergence = stepper.step(world)) {
      observer.diverged(divergence_error(scene.name, *divergence, world).what());
      break;
    }
    observer.after_step(world, stepper);
    if (world.steps % steps_per_frame == 0) observer.after_frame(world);
  }
  return observer.finish(world);
}

}  // namespace pneuma::app
