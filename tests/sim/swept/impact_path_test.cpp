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
  Vec3 angular_velocity;
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
  return {box.velocity + impulse / box.mass, box.angular_velocity + inverse * arm.cross(impulse)};
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
  explicit RandomImpact(unsigned seed) : random_(seed) {
    const ContactMaterial surface{0.5 + 0.5 * any(), 0.5 + 0.5 * any()};
    world_.settings.contact = ContactMethod::swept;
    world_.settings.gravity.setZero();
    // A box turns within a step: by a hundredth where steps are that short.
    world_.settings.steps_per_second = 960;
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

TEST(ImpactPath, ACornerThatHitsTheGroundLeavesItAsRouthAndStrongeSay) {
  int count = 0;
  for (unsigned seed = 1; seed <= 120; ++seed) {
    RandomImpact impact(seed);
    if (!impact.is_of_one_corner()) continue;
    ++count;
    const RigidBox& box = impact.box();
    const Motion expected = after_impact(box, lowest_corner(box).first, impact.ground());
    impact.run();
    EXPECT_LT((box.velocity - expected.velocity).norm(), 0.02 * fall) << seed;
    const double radius = 0.5 * box.size.norm();
    EXPECT_LT(radius * (box.angular_velocity - expected.angular_velocity).norm(), 0.02 * fall)
        << seed;
  }
  EXPECT_GT(count, 30);
}

}  // namespace
}  // namespace pneuma::sim
