// Impacts of boxes with friction, beside Routh's equations along the impulse.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/inspect/inspect.h"
#include "sim/mesh/rotation.h"
#include "sim/mesh/vec4d.h"
#include "sim/rigid/inertia.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

constexpr double fall = 5.0;  // m/s

struct Motion {
  Vec3 velocity;
  Vec3 spin;  // kg m^2/s
};

/// What pushes the corner by one N s upwards against the ground, which it slides along at `u`.
Vec3 with_friction(const Vec3& u, const Mat3& mobility, double friction) {
  const double slides = std::hypot(u.x(), u.y());
  if (slides > 1e-4 * fall) {
    return {-friction * u.x() / slides, -friction * u.y() / slides, 1.0};
  }
  Eigen::Vector2d holds = -mobility.topLeftCorner<2, 2>().inverse() * mobility.block<2, 1>(0, 2);
  if (holds.norm() > friction) holds *= friction / holds.norm();
  return {holds.x(), holds.y(), 1.0};
}

/// A corner at `arm` (m) from the middle of a box hits the ground: du = M dp, by steps so short
/// that only the slide's stop, found to 1e-4, is seen of them; until the work of compression has
/// come back but for 1 - restitution^2 (Stronge 1990).
Motion after_impact(const RigidBox& box, const Vec3& arm, const ContactMaterial& ground) {
  const Mat3 axes = box.orientation.toRotationMatrix();
  const Mat3 inverse = axes * body_inertia(box).cwiseInverse().asDiagonal() * axes.transpose();
  const Mat3 mobility =
      Mat3::Identity() / box.mass - cross_matrix(arm) * inverse * cross_matrix(arm);
  Vec3 u = box.velocity + box.angular_velocity.cross(arm), impulse = Vec3::Zero();
  const double part = 2e-5 * box.mass * fall, squared = ground.restitution * ground.restitution;
  double work = 0.0, of_compression = 0.0;
  while (u.z() < 0.0 || work - of_compression < -squared * of_compression) {
    const Vec3 push = part * with_friction(u, mobility, ground.friction);
    const Vec3 change = mobility * push;
    work += (u.z() + 0.5 * change.z()) * part;
    if (u.z() < 0.0) of_compression = work;
    u += change;
    impulse += push;
  }
  return {box.velocity + impulse / box.mass, spin(box) + arm.cross(impulse)};
}

/// The lowest corner of a box from its middle, and how far the next one is above it, m.
std::pair<Vec3, double> lowest_corner(const RigidBox& box) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5,
                    (i & 4) != 0 ? 0.5 : -0.5);
    corners.push_back(box.orientation * box.size.cwiseProduct(sign));
  }
  std::ranges::sort(corners, {}, [](const Vec3& corner) { return corner.z(); });
  return {corners[0], corners[1].z() - corners[0].z()};
}

class RandomImpact {
 public:
  RandomImpact(unsigned seed, int steps_per_second) : random_(seed) {
    const ContactMaterial surface{0.5 + 0.5 * any(), 0.5 + 0.5 * any()};
    world_.settings.contact = ContactMethod::swept;
    world_.settings.gravity.setZero();
    world_.settings.steps_per_second = steps_per_second;
    world_.settings.ground = surface;
    world_.rigid = {make_rigid(Vec3::Ones() + 0.5 * any_vector(), Vec3::Zero(), 2.0)};
    box().rho_g = 0.0;
    box().surface = surface;
    box().orientation = rotation_of_degrees(180.0 * any_vector());
    box().velocity = {fall * any(), fall * any(), -fall};
    box().position.z() = 0.03 - lowest_corner(box()).first.z();
  }

  bool is_of_one_corner() { return lowest_corner(box()).second > 0.2; }
  ContactMaterial ground() const { return *world_.settings.ground; }
  RigidBox& box() { return world_.rigid.front(); }

  /// Until the box has left the ground.
  void run() {
    Stepper stepper(world_);
    bool touched = false;
    for (int i = 0; i < 100; ++i) {
      ASSERT_FALSE(stepper.step(world_));
      if (touched && stepper.contacts().empty()) return;
      touched |= !stepper.contacts().empty();
    }
    FAIL() << "it does not part";
  }

 private:
  double any() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  Vec3 any_vector() { return {any(), any(), any()}; }

  std::mt19937 random_;
  World world_;
};

class CornerImpact : public testing::TestWithParam<int> {};

TEST_P(CornerImpact, LeavesTheGroundAsRouthAndStrongeSay) {
  int count = 0;
  for (unsigned seed = 1; seed <= 120; ++seed) {
    RandomImpact impact(seed, GetParam());
    if (!impact.is_of_one_corner()) continue;
    ++count;
    const RigidBox& box = impact.box();
    const Motion expected = after_impact(box, lowest_corner(box).first, impact.ground());
    impact.run();
    // Of sixteen parts until nothing approaches.
    EXPECT_LT((box.velocity - expected.velocity).norm(), 0.015 * fall) << seed;
    const double radius = 0.5 * box.size.norm();
    EXPECT_LT((spin(box) - expected.spin).norm(), 0.015 * fall * radius * box.mass) << seed;
  }
  EXPECT_GT(count, 30);
}

INSTANTIATE_TEST_SUITE_P(Steps, CornerImpact, testing::Values(60, 240, 960),
                         testing::PrintToStringParamName());

/// What is left of the energy of a cube that falls on an edge, two points of which hit the ground.
double left_by_edge(int steps_per_second) {
  World world;
  world.settings.contact = ContactMethod::swept;
  world.settings.gravity.setZero();
  world.settings.steps_per_second = steps_per_second;
  world.settings.ground = ContactMaterial{0.9, 0.4};
  world.rigid = {make_rigid(Vec3::Ones(), {0.0, 0.0, 0.62}, 1.0)};
  world.rigid[0].rho_g = 0.0;
  world.rigid[0].surface = *world.settings.ground;
  world.rigid[0].orientation = rotation_of_degrees({0.0, 3.0, 0.0});
  world.rigid[0].velocity.z() = -0.3;
  const double start = energy(world).kinetic;
  EXPECT_FALSE(run(world, 1.2));
  return energy(world).kinetic / start;
}

TEST(ImpactPath, OfAnEdgeConvergesWithTheStep) {
  const double expected = left_by_edge(15360);
  EXPECT_GT(expected, 0.5);
  EXPECT_LT(expected, 0.7);
  for (const int steps_per_second : {240, 960, 3840}) {
    EXPECT_NEAR(left_by_edge(steps_per_second), expected, 2e-3) << steps_per_second;
  }
}

/// Two boxes that meet obliquely, both turning, seen from a frame of this velocity.
World after_oblique_impact(const Vec3& frame) {
  World world = make_free_boxes({make_rigid({1.0, 1.2, 0.8}, {-0.7, 0.0, 0.0}, 1.0),
                                 make_rigid({0.9, 1.1, 1.0}, {0.9, 0.3, 0.2}, 3.0)},
                                0.7);
  world.settings.contact = ContactMethod::swept;
  world.settings.steps_per_second = 240;
  for (RigidBox& box : world.rigid) {
    box.surface.friction = 0.4;
    box.velocity = frame;
  }
  world.rigid[0].velocity += Vec3(4.0, 1.0, 0.5);
  world.rigid[0].orientation = rotation_of_degrees({20.0, 35.0, 10.0});
  world.rigid[1].angular_velocity = {0.5, 1.0, -2.0};
  EXPECT_FALSE(run(world, 0.25));
  return world;
}

TEST(ImpactPath, OfTwoBoxesIsTheSameInEveryFrame) {
  const Vec3 frame(30.0, -20.0, 10.0);
  const World still = after_oblique_impact(Vec3::Zero()), moved = after_oblique_impact(frame);
  EXPECT_GT((still.rigid[1].velocity).norm(), 0.5) << "they have met";
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT((moved.rigid[i].velocity - frame - still.rigid[i].velocity).norm(), 1e-8) << i;
    EXPECT_LT((moved.rigid[i].angular_velocity - still.rigid[i].angular_velocity).norm(), 1e-8)
        << i;
  }
}

}  // namespace
}  // namespace pneuma::sim
