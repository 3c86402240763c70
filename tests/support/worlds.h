// Small worlds that many tests start from.
#pragma once

#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/step/stepper.h"
#include "sim/world/world.h"

namespace pneuma::sim {

inline constexpr double g = 9.81;  // m/s^2

/// A body at rest in its rest shape, moved by `offset`.
inline SoftBody make_body(const TriangleMesh& mesh, const Vec3& offset = Vec3::Zero()) {
  SoftBody body;
  body.name = "body";
  body.mesh = make_soft_mesh(mesh);
  body.positions = body.mesh->rest_positions;
  body.velocities = VertexArray(body.positions.size());
  for (int v = 0; v < body.positions.size(); ++v) body.positions[v] += offset;
  return body;
}

inline double volume_of(const SoftBody& body) {
  return volume(body.mesh->topology, body.positions);
}

/// Moves every vertex, and gives it a velocity, by up to `amount` in each coordinate.
inline void perturb(SoftBody& body, double amount, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  const auto draw = [&] {  // one by one: compilers differ in the order of a call's arguments
    const double z = uniform(random), y = uniform(random), x = uniform(random);
    return Vec3(x, y, z);
  };
  for (int v = 0; v < body.positions.size(); ++v) {
    body.positions[v] += draw();
    body.velocities[v] += draw();
  }
}

inline void undamp(SoftMaterial& material) {
  material.rho_g = 0.0;
  material.k_max = std::numeric_limits<double>::infinity();
}

/// One body without ground or gravity.
inline World make_free_world(SoftBody body) {
  World world;
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.soft.push_back(std::move(body));
  return world;
}

/// Bodies kept apart by the paper's impulses, after they have moved.
inline World by_impulses(World world = {}) {
  world.settings.contact = ContactMethod::impulses;
  return world;
}

/// A box at rest with its sides along the axes.
inline RigidBox make_rigid(const Vec3& size, const Vec3& position, double mass = 1.0) {
  RigidBox box;
  box.name = "box";
  box.size = size;
  box.mass = mass;
  box.position = position;
  return box;
}

/// Boxes without ground, gravity, drag or friction, that bounce with `restitution`.
inline World make_free_boxes(std::vector<RigidBox> boxes, double restitution) {
  World world;
  world.settings.ground.reset();
  world.settings.gravity.setZero();
  world.rigid = std::move(boxes);
  for (RigidBox& box : world.rigid) {
    box.rho_g = 0.0;
    box.surface = {restitution, 0.0};
  }
  return world;
}

/// Steps until `seconds` more have passed. A divergence is a test's failure to check for.
[[nodiscard]] inline std::optional<Divergence> run(World& world, double seconds,
                                                   StepperOptions options = {}) {
  Stepper stepper(world, std::move(options));
  const auto steps = static_cast<std::int64_t>(seconds * world.settings.steps_per_second + 0.5);
  for (std::int64_t i = 0; i < steps; ++i) {
    if (auto divergence = stepper.step(world)) return divergence;
  }
  return std::nullopt;
}

/// Of a copy of the world, with a stepper of its own. Throws std::runtime_error if it diverges.
inline std::uint64_t state_hash_after(World world, double seconds, int threads) {
  StepperOptions options;
  options.threads = threads;
  if (const auto divergence = run(world, seconds, std::move(options))) {
    throw std::runtime_error(divergence->body + ": " + divergence->what);
  }
  return state_hash(world);
}

/// Steps until something touches; the last step is the one that resolved it. Returns the state of
/// `box` before that step.
inline RigidBox step_until_contact(World& world, std::size_t box) {
  Stepper stepper(world);
  for (int i = 0; i < 600; ++i) {
    const RigidBox before = world.rigid[box];
    if (stepper.step(world)) break;
    if (!stepper.contacts().empty()) return before;
  }
  throw std::runtime_error("nothing touched");
}

/// Names of the stages and kinds of contact that a plan leaves out.
inline std::vector<std::string> left_out(const Plan& plan) {
  std::vector<std::string> names;
  for (int i = 0; i < stage_count; ++i) {
    if (!plan.runs(Stage{i})) names.emplace_back(to_string(Stage{i}));
  }
  for (int i = 0; i < contact_kind_count; ++i) {
    if (!plan.runs(ContactKind{i})) names.emplace_back(to_string(ContactKind{i}));
  }
  return names;
}

}  // namespace pneuma::sim
