// Boxes that slide, topple and spin, beside the closed forms of their motion.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

constexpr double g = 9.81;        // m/s^2
constexpr double friction = 0.5;  // Coulomb's mu

/// A box at rest on the ground, or on a static slab.
World make_world(const RigidBox& box, bool on_slab) {
  World world;
  world.settings.contact = ContactMethod::swept;
  world.settings.ground = ContactMaterial{0.0, friction};
  world.rigid = {box};
  world.rigid[0].rho_g = 0.0;
  world.rigid[0].surface = {0.0, friction};
  if (on_slab) {
    world.rigid.push_back(make_rigid({100.0, 100.0, 1.0}, {0.0, 0.0, 9.5}));
    world.rigid[1].is_kinematic = true;
    world.rigid[1].surface = {0.0, friction};
    world.rigid[0].position.z() += 10.0;
  }
  return world;
}

void tilt(World& world, double tangent) {
  world.settings.gravity = g * Vec3(tangent, 0.0, -1.0).normalized();
}

class ClosedForms : public testing::TestWithParam<bool> {};

TEST_P(ClosedForms, ABoxSlidesFromTheAngleOfRepose) {
  const RigidBox box = make_rigid({2.0, 2.0, 1.0}, {0.0, 0.0, 0.5});
  const auto slid = [&](double tangent) {
    World world = make_world(box, GetParam());
    tilt(world, tangent);
    EXPECT_FALSE(run(world, 2.0));
    return world.rigid[0].position.x();
  };
  EXPECT_LT(std::abs(slid(0.99 * friction)), 1e-3);
  // g (sin - mu cos) t^2 / 2.
  for (const double tangent : {1.01 * friction, 0.6, 1.0}) {
    const double way = g * (tangent - friction) / std::hypot(1.0, tangent) * 2.0;
    EXPECT_NEAR(slid(tangent) / way, 1.0, 1e-3) << tangent;
  }
}

TEST_P(ClosedForms, ABoxTipsWhereItsWeightLeavesItsFoot) {
  const auto leans = [&](double tangent) {
    World world = make_world(make_rigid({0.8, 2.0, 2.0}, {0.0, 0.0, 1.0}), GetParam());
    tilt(world, tangent);
    EXPECT_FALSE(run(world, 6.0));
    return (world.rigid[0].orientation * Vec3::UnitZ()).x();  // the sine
  };
  constexpr double foot = 0.8 / 2.0;  // width over height, less than the friction
  EXPECT_LT(leans(0.99 * foot), 1e-3);
  EXPECT_GT(leans(1.01 * foot), 0.5);
}

/// Each of four corners carries a quarter of the weight: friction takes mu m g r off the spin, r
/// from the axis to a corner.
TEST_P(ClosedForms, SpinOnFourCornersEndsInTime) {
  RigidBox box = make_rigid({2.0, 1.0, 0.2}, {0.0, 0.0, 0.1}, 3.0);
  box.angular_velocity = {0.0, 0.0, 6.0};
  World world = make_world(box, GetParam());
  const double squares = 2.0 * 2.0 + 1.0;
  const double inertia = box.mass * squares / 12.0, arm = 0.5 * std::sqrt(squares);
  const double slowing = friction * box.mass * g * arm / inertia;  // rad/s^2
  const double end = 6.0 / slowing;
  ASSERT_FALSE(run(world, 0.5 * end));
  EXPECT_NEAR(world.rigid[0].angular_velocity.z(), 6.0 - slowing * time(world), 0.001 * 6.0);
  ASSERT_FALSE(run(world, end));
  EXPECT_LT(world.rigid[0].angular_velocity.norm(), 1e-6);
  const double angle =
      2.0 * std::atan2(world.rigid[0].orientation.z(), world.rigid[0].orientation.w());
  EXPECT_NEAR(angle, 0.5 * 6.0 * end, 0.005 * 0.5 * 6.0 * end);
}

INSTANTIATE_TEST_SUITE_P(OnGroundAndSlab, ClosedForms, testing::Bool());

}  // namespace
}  // namespace pneuma::sim
