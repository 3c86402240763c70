// Random scenes: whatever starts apart never crosses, and implicit steps gain no energy.
#include <gtest/gtest.h>

#include <random>

#include "sim/inspect/crossings.h"
#include "sim/rigid/rigid_motion.h"
#include "tests/sim/potential/potential_worlds.h"

namespace pneuma::sim {
namespace {

TriangleMesh random_mesh(std::mt19937_64& random) {
  switch (random() % 4) {
    case 0:
      return make_icosphere(1.0, 1);
    case 1:
      return make_torus(0.8, 0.3, 8, 6);
    case 2:
      return make_box({1.2, 0.6, 1.6}, 2);
    default:
      return make_sphere(0.9, 5, 6);
  }
}

SoftBody random_soft_body(std::mt19937_64& random, const Vec3& place, const Vec3& velocity) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  SoftBody body = make_body(random_mesh(random), place);
  body.material.k = std::pow(10.0, uniform(1.0, 4.0));
  body.material.k_max = 2.0 * body.material.k;
  body.material.n = uniform(0.0, 0.1);
  body.material.vertex_mass = std::pow(10.0, uniform(-2.0, 0.0));
  body.material.surface = {uniform(0.0, 1.0), uniform(0.0, 1.0)};
  for (int v = 0; v < body.velocities.size(); ++v) body.velocities[v] = velocity;
  return body;
}

/// A thousand times as heavy as another at most.
RigidBox random_box(std::mt19937_64& random, const Vec3& place, const Vec3& velocity) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const Vec3 size(uniform(0.3, 1.4), uniform(0.3, 1.4), uniform(0.3, 1.4));
  RigidBox box = make_rigid(size, place, std::pow(10.0, uniform(-1.0, 2.0)));
  box.surface = {uniform(0.0, 1.0), uniform(0.0, 1.0)};
  box.orientation = turned(box.orientation, {uniform(-3, 3), uniform(-3, 3), uniform(-3, 3)});
  box.velocity = velocity;
  box.angular_velocity = {uniform(-8, 8), uniform(-8, 8), uniform(-8, 8)};
  return box;
}

/// Soft bodies and free boxes that fly at each other over the ground or a static box, 1 to 4 of
/// them, in every tenth world up to 20.
World random_world(unsigned seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const std::array rates = {30, 60, 240};
  World world = potential_world(seed % 2 == 0 ? Integrator::implicit_euler : Integrator::sdirk2,
                                rates[seed % 3]);
  const int count = 1 + static_cast<int>(seed % 10 == 9 ? random() % 20 : random() % 4);
  const int side = count <= 4 ? 2 : 3;
  const double spacing = 2.7;
  const Vec3 middle(0.5 * spacing * (side - 1), 0.5 * spacing * (side - 1), 1.0);
  for (int i = 0; i < count; ++i) {
    const Vec3 place(spacing * (i % side), spacing * (i / side % side),
                     spacing * (i / (side * side)) + uniform(1.4, 1.8));
    const Vec3 velocity = uniform(0.0, 15.0) * (middle - place).normalized();
    if (random() % 3 == 0) {
      world.rigid.push_back(random_box(random, place, velocity));
    } else {
      world.soft.push_back(random_soft_body(random, place, velocity));
    }
  }
  if (seed % 3 == 0) {
    world.rigid.push_back(make_rigid({12, 12, 0.3}, {2, 2, 0.2}));
    world.rigid.back().is_kinematic = true;
  }
  return world;
}

void expect_no_crossing_and_no_energy_gained(unsigned seed) {
  World world = random_world(seed);
  Stepper stepper(world);
  double before = energy(world).total();
  const int steps = world.settings.steps_per_second * 2 / 3;
  for (int i = 0; i < steps; ++i) {
    const auto divergence = stepper.step(world);
    ASSERT_FALSE(divergence) << "seed " << seed << ": " << divergence->what;
    const double after = energy(world).total();
    // Rounding of the energies' terms, which are far greater than their sum.
    EXPECT_LE(after, before + 1e-9 * (std::abs(before) + 1.0)) << "seed " << seed << ", step " << i;
    before = after;
    const Crossings found = crossings(world);
    ASSERT_EQ(found.between_bodies + found.within_bodies, 0) << "seed " << seed << ", step " << i;
    for (const SoftBody& body : world.soft) {
      ASSERT_GT(volume(body.mesh->topology, body.positions), 0.0) << "seed " << seed;
    }
  }
}

TEST(RandomWorldsByPotential, NeverCrossAndGainNoEnergy) {
  for (unsigned seed = 0; seed < 6; ++seed) expect_no_crossing_and_no_energy_gained(seed);
}

TEST(HundredRandomWorldsByPotential, NeverCrossAndGainNoEnergy) {
  for (unsigned seed = 6; seed < 100; ++seed) expect_no_crossing_and_no_energy_gained(seed);
}

TEST(ManyRandomWorldsByPotential, NeverCrossAndGainNoEnergy) {
  for (unsigned seed = 100; seed < 1100; ++seed) expect_no_crossing_and_no_energy_gained(seed);
}

}  // namespace
}  // namespace pneuma::sim
