#include "benchmarks/peer/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/host/clock.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/overlap.h"
#include "sim/mesh/measure.h"

namespace pneuma::benchmarks {
namespace {

constexpr double lost_inflation = 100.0;  // beyond it a run has come apart

double fastest_centre(const sim::World& world) {
  double speed = 0.0;
  for (const sim::SoftBody& body : world.soft) {
    speed = std::max(speed, body.velocities.rows().rowwise().mean().norm());
  }
  for (const sim::RigidBox& box : world.rigid) speed = std::max(speed, box.velocity.norm());
  return speed;
}

double deepest_overlap(const sim::World& world) {
  double depth = 0.0;
  for (const sim::Overlap& overlap : sim::overlaps(world)) depth = std::max(depth, overlap.depth);
  return depth;
}

}  // namespace

double soft_volume(const sim::World& world) {
  double sum = 0.0;
  for (const sim::SoftBody& body : world.soft) {
    sum += sim::volume(body.mesh->topology, body.positions);
  }
  return sum;
}

bool inflates_like(const Quality& peer, const Quality& ours) {
  return std::abs(peer.inflation / ours.inflation - 1.0) <= inflation_bound;
}

bool rests_like(const Quality& peer, const Quality& ours) {
  return peer.end_speed <= std::max(speed_bound, ours.end_speed);
}

bool keeps_apart_like(const Quality& peer, const Quality& ours) {
  return peer.deepest <= std::max(depth_bound, ours.deepest);
}

double shortfall(const Quality& peer, const Quality& ours) {
  if (!std::isfinite(peer.inflation)) return std::numeric_limits<double>::infinity();
  const double rest = std::max(peer.end_speed / std::max(speed_bound, ours.end_speed) - 1.0, 0.0);
  const double inflation =
      std::max(std::abs(peer.inflation / ours.inflation - 1.0) / inflation_bound - 1.0, 0.0);
  const double depth = std::max(peer.deepest / std::max(depth_bound, ours.deepest) - 1.0, 0.0);
  constexpr double rest_first = 1e3;  // no peer's body is to move where ours rests
  return rest_first * rest + std::max(inflation, depth);
}

Trial try_out(Simulation& simulation, double seconds) {
  const double start = soft_volume(simulation.state());
  const int tenth = simulation.state().settings.steps_per_second / 10;  // steps
  const int tenths = static_cast<int>(10.0 * seconds + 0.5);
  Trial trial;
  Quality& quality = trial.quality;
  double volumes = 0.0;
  double took = 0.0;
  for (int i = 1; i <= tenths; ++i) {
    const double before = app::thread_seconds();
    simulation.advance(tenth);
    if (2 * i > tenths) took += app::thread_seconds() - before;
    const sim::World& world = simulation.state();
    const double volume = soft_volume(world);
    if (!(std::abs(volume) < lost_inflation * start)) {
      quality.inflation = std::numeric_limits<double>::infinity();
      return trial;
    }
    if (i > tenths - 10) {
      volumes += volume;
      quality.end_speed = std::max(quality.end_speed, fastest_centre(world));
    }
    if (2 * i > tenths && i % 5 == 0) {
      quality.deepest = std::max(quality.deepest, deepest_overlap(world));
      quality.crossings = std::max(quality.crossings, sim::crossings(world).between_bodies);
    }
  }
  quality.inflation = volumes / std::min(tenths, 10) / start;
  trial.frame_seconds = took / (tenths - tenths / 2) * 10.0 / 60.0;
  return trial;
}

}  // namespace pneuma::benchmarks
