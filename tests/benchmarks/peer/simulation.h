// A world that one of the two sides steps, seen alike.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "benchmarks/peer/bullet_world.h"
#include "sim/world/world.h"

namespace pneuma::benchmarks {

class Simulation {
 public:
  virtual ~Simulation() = default;
  /// `count` steps of the world's length. Ours throws app::DivergenceError.
  virtual void advance(int count) = 0;
  /// Contacts that the last step found; ours are regions, Bullet's nodes.
  virtual std::size_t contact_count() const = 0;
  /// As it is now.
  virtual const sim::World& state() = 0;
};

std::unique_ptr<Simulation> simulate_by_bullet(const sim::World& start,
                                               const BulletOptions& options);
/// With the world's integrator; errors name the scene.
std::unique_ptr<Simulation> simulate_by_ours(const sim::World& start, const std::string& name,
                                             int threads = 1);

}  // namespace pneuma::benchmarks
