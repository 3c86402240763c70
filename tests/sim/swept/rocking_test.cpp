// A slender block that rocks on its edges: each impact turns it about the other edge, by angular
// momentum about that one (Housner 1963). What bears its weight until then is the edge before.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/inspect/inspect.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

struct Block {
  double width, height;  // m
  double tilt;           // rad, at the start
};

/// On its right edge, at rest on the ground.
World make_rocking_block(const Block& block, int steps_per_second) {
  World world = make_swept_world();
  world.settings.steps_per_second = steps_per_second;
  world.settings.ground = ContactMaterial{0.0, 1.0};
  const double radius = 0.5 * std::hypot(block.width, block.height);
  const double angle = std::atan(block.width / block.height) - block.tilt;
  const Vec3 middle(-radius * std::sin(angle), 0.0, radius * std::cos(angle));
  world.rigid.push_back(make_rigid({block.width, block.width, block.height}, middle));
  RigidBox& box = world.rigid.back();
  box.orientation = Eigen::AngleAxisd(block.tilt, Vec3::UnitY());
  box.surface = {0.0, 1.0};
  box.rho_g = 0.0;
  return world;
}

/// Whose top bears the block. `thickness`: m.
void add_slab(World& world, double thickness) {
  world.rigid[0].position.z() += thickness;
  RigidBox slab = make_rigid({4.0, 4.0, thickness}, {0.0, 0.0, 0.5 * thickness});
  slab.surface = world.rigid[0].surface;
  slab.is_kinematic = true;
  world.rigid.push_back(slab);
}

/// J, at rest.
double energy_upright(World world, double height) {
  world.rigid[0].position.z() = height;
  return energy(world).total();
}

double tilt(const World& world) { return 2.0 * std::asin(world.rigid[0].orientation.y()); }

/// The energy over that of the block upright, J, at the start and at the greatest tilt after each
/// impact.
std::vector<double> energies_of_swings(World world, double upright, double seconds) {
  std::vector<double> energies{energy(world).total() - upright};
  Stepper stepper(world);
  double side = 1.0;
  bool rises = false;
  while (time(world) < seconds) {
    if (stepper.step(world)) return {};
    const double turns = world.rigid[0].angular_velocity.y();
    if (tilt(world) * side < 0.0) {
      side = -side;
      rises = true;
    } else if (rises && turns * side < 0.0) {
      energies.push_back(energy(world).total() - upright);
      rises = false;
    }
  }
  return energies;
}

/// On the ground, or a slab whose top is at `floor` (m). `tolerance`: of the ratio of two swings'
/// energies, which begin with the weight times 41 thousandths of the width, or 32 of the slender
/// block.
void expect_losses_of_impacts(double floor, double tolerance) {
  for (const Block& block : {Block{0.5, 2.0, 0.105}, Block{0.05, 0.3, 0.087}}) {
    for (const int steps_per_second : {60, 240}) {
      World world = make_rocking_block(block, steps_per_second);
      if (floor > 0.0) add_slab(world, floor);
      const double upright = energy_upright(world, floor + 0.5 * block.height);
      const std::vector<double> energies = energies_of_swings(world, upright, 1.6);
      ASSERT_GE(energies.size(), 3u);
      const double sine = std::sin(std::atan(block.width / block.height));
      const double ratio = std::pow(1.0 - 1.5 * sine * sine, 2);
      for (std::size_t i = 0; i + 1 < 3; ++i) {
        EXPECT_NEAR(energies[i + 1] / energies[i], ratio, tolerance * ratio)
            << block.width << ' ' << steps_per_second << ' ' << i;
      }
    }
  }
}

TEST(RockingBlock, LosesByEachImpactWhatItsAngularMomentumAsks) {
  // A corner is stopped up to a thousandth of the width over the ground.
  expect_losses_of_impacts(0.0, 0.05);
}

TEST(RockingBlock, LosesAsMuchOnASlab) {
  // It is stopped three to seven thousandths of the width over the slab.
  expect_losses_of_impacts(0.5, 0.1);
}

}  // namespace
}  // namespace pneuma::sim
