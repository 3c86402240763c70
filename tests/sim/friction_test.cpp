// Coulomb friction in the impulses of random contacts.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/inspect.h"
#include "tests/sim/random_contacts.h"

namespace pneuma::sim {
namespace {

constexpr int trials = 100'000;

TEST(Friction, StaysWithinCoulombsLimitAndAcrossTheNormal) {
  RandomContacts random(8);
  int sticking = 0, slipping = 0;
  for (int trial = 0; trial < trials; ++trial) {
    random.next();
    World& world = random.world();
    const Contact& contact = random.contact();
    const double mu = pair_surface(world, contact).friction;
    double work = 0.0;
    ContactImpulse impulse(world, random.masses(), contact, random.uniform(0.0, 20.0), work);
    resolve(impulse);
    const auto& [normal, friction] = impulse.impulse();
    ASSERT_LE(friction.norm(), mu * normal * (1.0 + 1e-14));  // scaled down to it: rounding
    // Nothing of it is along the normal.
    ASSERT_NEAR(impulse.total().dot(contact.normal), normal, 1e-14 * impulse.total().norm());
    ASSERT_NEAR(impulse.total().squaredNorm(), normal * normal + friction.squaredNorm(),
                1e-14 * impulse.total().squaredNorm());
    if (normal > 0.0) ++(impulse.sticks() ? sticking : slipping);
  }
  EXPECT_GT(sticking, trials / 20);
  EXPECT_GT(slipping, trials / 20);
}

TEST(Friction, OfPointMassesIsAlongTheSlidingAndStopsItAtMost) {
  RandomContacts random(9);
  for (int trial = 0; trial < trials; ++trial) {
    random.next();
    const Contact& contact = random.contact();
    if (has_box(contact)) continue;
    World& world = random.world();
    const Sides before(world, contact);
    const auto sliding = [&](const Sides& sides) -> Vec3 {
      const Vec3 v = sides.relative_velocity();
      return v - v.dot(contact.normal) * contact.normal;
    };
    const Vec3 slides = sliding(before);
    const double approach = -before.relative_velocity().dot(contact.normal);
    double work = 0.0;
    ContactImpulse impulse(world, random.masses(), contact, approach, work);
    resolve(impulse);
    const ContactMaterial pair = pair_surface(world, contact);
    const bool bounces = pair.restitution * approach >= min_bounce_speed;
    const double stopped = pair.friction * (bounces ? 1.0 + pair.restitution : 1.0) *
                           std::max(0.0, approach) / slides.norm();
    const Vec3 expected = std::max(0.0, 1.0 - stopped) * slides;
    ASSERT_LT((sliding(Sides(world, contact)) - expected).norm(), 1e-12);  // of about 10 m/s
  }
}

/// How much of a velocity along the normal an impulse across it makes, in units of what the same
/// impulse along the normal makes.
double tangential_coupling(const Sides& sides, const Vec3& normal) {
  Vec3 response = Vec3::Zero();  // to an impulse of 1 N s along the normal
  for (const Side& side : {sides.first, sides.second}) {
    const Vec3 spin = side.inverse_inertia * side.arm.cross(normal);
    response += side.inverse_mass * normal + spin.cross(side.arm);
  }
  const double along = response.dot(normal);
  return (response - along * normal).norm() / along;
}

TEST(Friction, RepeatedCorrectionsOfBoxesEndInSticksOrSlips) {
  // The normal and the two directions across it disturb each other through the rotation, so that a
  // single call does not end in one of the two: no motion at all, or sliding with the friction at
  // its limit.
  RandomContacts random(10);
  int sticking = 0, slipping = 0, unsettled = 0;
  for (int trial = 0; trial < trials / 10; ++trial) {
    random.next();
    const Contact& contact = random.contact();
    if (!has_box(contact)) continue;
    World& world = random.world();
    double work = 0.0;
    ContactImpulse impulse(world, random.masses(), contact, 0.0, work);
    double change = 1.0;
    // The rounding of speeds of which the normal impulse may stop a hundredth.
    constexpr double settled = 1e-12;
    for (int i = 0; i < 1000 && change > settled * impulse.impulse().normal; ++i) {
      change = impulse.correct();
    }
    const auto& [normal, friction] = impulse.impulse();
    if (normal == 0.0) continue;
    if (change > settled * normal) {
      ++unsettled;
      // The friction that stops the sliding brings the point back by about as much as the impulse
      // along the normal had pushed it away, again and again: only where mu and the arms are great.
      const double mu = pair_surface(world, contact).friction;
      EXPECT_GT(mu * tangential_coupling(Sides(world, contact), contact.normal), 0.75) << trial;
      continue;
    }
    const Vec3 velocity = Sides(world, contact).relative_velocity();
    ASSERT_NEAR(velocity.dot(contact.normal), 0.0, 1e-9) << trial;
    if (impulse.sticks()) {
      ++sticking;
      ASSERT_LT(velocity.norm(), 1e-9) << trial;
    } else {
      ++slipping;
      ASSERT_NEAR(friction.norm() / normal, pair_surface(world, contact).friction, 1e-13) << trial;
      ASSERT_LT((impulse.total() - normal * contact.normal).dot(velocity), 0.0) << trial;
    }
  }
  EXPECT_GT(sticking, 300);
  EXPECT_GT(slipping, 1000);
  EXPECT_LT(unsettled, (sticking + slipping) / 20);
}

}  // namespace
}  // namespace pneuma::sim
