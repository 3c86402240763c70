#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/inspect.h"
#include "sim/rigid/inertia.h"
#include "tests/sim/random_contacts.h"

namespace pneuma::sim {
namespace {

constexpr int trials = 100'000;

bool has_ground(const Contact& contact) { return contact.second.kind == SideKind::ground; }
bool are_boxes(const Contact& contact) {
  return contact.first.kind == SideKind::rigid && contact.second.kind == SideKind::rigid;
}

/// The sum of all |m v|, which the rounding of a sum of momenta is relative to; likewise the
/// moments and what the boxes' spins are made of.
struct Scale {
  double linear = 0.0, angular = 0.0;
};
Scale momentum_scale(const World& world) {
  Scale scale;
  for (const SoftBody& body : world.soft) {
    for (int v = 0; v < body.positions.size(); ++v) {
      const double linear = body.material.vertex_mass * body.velocities[v].norm();
      scale.linear += linear;
      scale.angular += linear * body.positions[v].norm();
    }
  }
  for (const RigidBox& box : world.rigid) {
    const double linear = box.mass * box.velocity.norm();
    scale.linear += linear;
    scale.angular +=
        linear * box.position.norm() + body_inertia(box).maxCoeff() * box.angular_velocity.norm();
  }
  return scale;
}

/// J, of the bodies that a contact can move, which may be light ones in a world of heavy ones.
double participants_energy(const World& world, const Contact& contact) {
  double sum = 0.0;
  for (const ContactSide& side : {contact.first, contact.second}) {
    if (side.kind == SideKind::soft) sum += energy(world.soft[at(side.body)], Vec3::Zero()).kinetic;
    if (side.kind != SideKind::rigid) continue;
    World alone;
    alone.rigid.push_back(world.rigid[at(side.body)]);
    sum += energy(alone).kinetic;
  }
  return sum;
}

TEST(Impulse, MomentumIsKeptAndEnergyNeverGrows) {
  RandomContacts random(1);
  double worst_linear = 0.0, worst_angular = 0.0, worst_gain = 0.0;
  int pushed = 0;
  for (int trial = 0; trial < trials; ++trial) {
    random.next();
    World& world = random.world();
    Contact contact = random.contact();
    if (contact.first.kind == SideKind::rigid && trial % 3 == 0) {
      contact.speculative_margin =
          random.uniform(0.0, 0.2);  // of boxes only; at 1/60 s it takes up to 12 m/s
    }
    const Momentum before = momentum(world);
    const Scale scale = momentum_scale(world);
    const double energy_before = participants_energy(world, contact);
    double work = 0.0;
    ContactImpulse impulse(world, random.masses(), contact, random.uniform(-30.0, 30.0), work);
    resolve(impulse, 1 + trial % 10);
    const Momentum after = momentum(world);
    const double energy_after = participants_energy(world, contact);

    ASSERT_GE(impulse.impulse().normal, 0.0);
    pushed += impulse.impulse().normal > 0.0 ? 1 : 0;
    // What the ground got is not in the world's sum.
    const Vec3 to_ground = has_ground(contact) ? Vec3(-impulse.total()) : Vec3::Zero();
    const Scale scale_after = momentum_scale(world);
    worst_linear = std::max(worst_linear, (after.linear + to_ground - before.linear).norm() /
                                              std::max(scale.linear, scale_after.linear));
    if (are_boxes(contact)) {
      worst_angular = std::max(worst_angular, (after.angular - before.angular).norm() /
                                                  std::max(scale.angular, scale_after.angular));
    }
    worst_gain = std::max(worst_gain, energy_after / energy_before - 1.0);
  }
  EXPECT_GT(pushed, trials / 4);
  // A few roundings of each of 48 + 8 numbers.
  EXPECT_LT(worst_linear, 1e-14);
  // The change of spin goes through I^-1 and back through I, whose moments differ up to 300-fold.
  EXPECT_LT(worst_angular, 1e-13);
  // At restitution 1 the energy is the same up to the rounding of a sum of 50 squares.
  EXPECT_LT(worst_gain, 1e-13);
}

TEST(Impulse, AngularMomentumOfTwoBoxesIsKeptAboutAnyPoint) {
  // L about p is L about the origin less p x P: kept about any p because both are. A shift of the
  // whole world by p is an independent way to the same.
  RandomContacts random(2);
  for (int trial = 0; trial < 2000; ++trial) {
    do random.next();
    while (!are_boxes(random.contact()));
    World& world = random.world();
    const Vec3 p{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)};
    Contact contact = random.contact();
    contact.point += p;
    for (RigidBox& box : world.rigid) box.position += p;
    world.soft.clear();
    const Vec3 before = momentum(world).angular;
    const double scale = momentum_scale(world).angular;
    double work = 0.0;
    ContactImpulse impulse(world, random.masses(), contact, 0.0, work);
    resolve(impulse);
    ASSERT_LT((momentum(world).angular - before).norm(), 1e-13 * scale);
    random = RandomContacts(static_cast<std::uint64_t>(trial) + 3);
  }
}

void without_friction(World& world) {
  for (SoftBody& body : world.soft) body.material.surface.friction = 0.0;
  for (RigidBox& box : world.rigid) box.surface.friction = 0.0;
}

TEST(Impulse, IsThePapers) {
  RandomContacts random(4);
  for (int trial = 0; trial < trials; ++trial) {
    random.next();
    World& world = random.world();
    without_friction(world);  // which the paper's equation knows nothing of
    const Contact& contact = random.contact();
    const Vec3& n = contact.normal;
    const Sides before(world, contact);
    const ContactMaterial pair = pair_surface(world, contact);
    const double approach = -before.relative_velocity().dot(n);
    const bool bounces = pair.restitution * approach >= min_bounce_speed;
    const double j = (bounces ? 1.0 + pair.restitution : 1.0) * approach / before.inverse_mass(n);

    double work = 0.0;
    ContactImpulse impulse(world, random.masses(), contact, approach, work);
    impulse.correct();
    if (impulse.bounce()) impulse.correct();
    // Cancellation in the relative velocity, whose terms reach |omega| |r| = 60 m/s, and in the
    // denominator, which is a sum of positive terms only when written as a quadratic form.
    const double rounding = 1e-12 * (1.0 + std::abs(approach)) / before.inverse_mass(n);
    ASSERT_NEAR(impulse.impulse().normal, std::max(0.0, j), rounding + 1e-11 * std::abs(j));
  }
}

TEST(Impulse, OfWhatForcesAddWithinTheStepNothingComesBack) {
  RandomContacts random(5);
  for (int trial = 0; trial < trials; ++trial) {
    random.next();
    World& world = random.world();
    without_friction(world);
    const Contact& contact = random.contact();
    const double approach = -Sides(world, contact).relative_velocity().dot(contact.normal);
    if (approach <= 0.0) continue;
    const double start_approach = random.uniform(-1.5, 1.5) * approach;
    const double epsilon = pair_surface(world, contact).restitution;
    double work = 0.0;
    ContactImpulse impulse(world, random.masses(), contact, start_approach, work);
    resolve(impulse);
    const double parting = Sides(world, contact).relative_velocity().dot(contact.normal);
    const double bounce = epsilon * std::clamp(start_approach, 0.0, approach);
    ASSERT_NEAR(parting, bounce < min_bounce_speed ? 0.0 : bounce, 1e-11 * approach + 1e-12);
  }
}

TEST(Impulse, AGapMayStillClose) {
  RandomContacts random(6);
  for (int trial = 0; trial < trials / 10; ++trial) {
    random.next();
    World& world = random.world();
    without_friction(world);
    Contact contact = random.contact();
    if (contact.first.kind != SideKind::rigid || contact.second.kind == SideKind::soft) continue;
    contact.speculative_margin = random.uniform(0.01, 0.2);
    const double margin_speed = contact.speculative_margin * world.settings.steps_per_second;
    const double approach = -Sides(world, contact).relative_velocity().dot(contact.normal);
    double work = 0.0;
    ContactImpulse impulse(world, random.masses(), contact, 0.5 * margin_speed, work);
    impulse.correct();
    const double parting = Sides(world, contact).relative_velocity().dot(contact.normal);
    ASSERT_NEAR(parting, std::max(-approach, -margin_speed), 1e-11 * (1.0 + std::abs(approach)));
  }
}

TEST(Impulse, SeparatingSidesAreLeftAlone) {
  RandomContacts random(7);
  int separating = 0;
  for (int trial = 0; trial < trials / 10; ++trial) {
    random.next();
    World& world = random.world();
    if (Sides(world, random.contact()).relative_velocity().dot(random.contact().normal) < 1e-9) {
      continue;
    }
    ++separating;
    const std::uint64_t before = state_hash(world);
    double work = 0.0;
    ContactImpulse impulse(world, random.masses(), random.contact(), 1.0, work);
    ASSERT_EQ(impulse.correct(), 0.0);
    ASSERT_FALSE(impulse.bounce());
    ASSERT_EQ(state_hash(world), before);
    ASSERT_EQ(impulse.total(), Vec3::Zero());
  }
  EXPECT_GT(separating, trials / 40);
}

/// The middle of a soft feature, the centre of a box.
Vec3 place(const World& world, const ContactSide& side) {
  if (side.kind == SideKind::rigid) return world.rigid[at(side.body)].position;
  if (side.kind == SideKind::ground) return Vec3::Zero();
  Vec3 sum = Vec3::Zero();
  const auto vertices = world.soft[at(side.body)].mesh->topology.feature_vertices(side.feature);
  for (const int v : vertices) sum += world.soft[at(side.body)].positions[v];
  return sum / static_cast<double>(vertices.size());
}

TEST(Separation, IsSharedByInverseMassesAndLeavesTheCentreOfMass) {
  RandomContacts random(11);
  for (int trial = 0; trial < trials / 10; ++trial) {
    random.next();
    World& world = random.world();
    Contact contact = random.contact();
    contact.depth = random.uniform(-0.2, 1.0);
    const Sides sides(world, contact);
    const Vec3 first = place(world, contact.first), second = place(world, contact.second);
    double work = 0.0;
    ContactImpulse impulse(world, random.masses(), contact, 0.0, work);
    impulse.separate(1.0);
    const Vec3 first_moved = place(world, contact.first) - first;
    const Vec3 second_moved = place(world, contact.second) - second;
    const Vec3 apart = std::max(0.0, contact.depth) * contact.normal;
    ASSERT_LT((first_moved - second_moved - apart).norm(), 1e-14);  // of places of about 2 m
    // m0 d0 + m1 d1 = 0, as d0 / w0 + d1 / w1 = 0 with inverse masses, which may be 0.
    const double w0 = sides.first.inverse_mass, w1 = sides.second.inverse_mass;
    ASSERT_LT((w1 * first_moved + w0 * second_moved).norm(), 1e-14 * (w0 + w1));
    if (contact.depth < 0.0) {
      ASSERT_EQ(first_moved, Vec3::Zero());
      ASSERT_EQ(second_moved, Vec3::Zero());
    }
    // A second time there is nothing left but the rounding of the first.
    impulse.separate(1.0);
    ASSERT_LT((place(world, contact.first) - first - first_moved).norm(), 1e-14);
    ASSERT_LT((place(world, contact.second) - second - second_moved).norm(), 1e-14);
  }
}

TEST(Surface, OfAPairHasTheGreaterRestitutionAndTheMeanFriction) {
  const ContactMaterial pair = combine({0.3, 0.2}, {0.7, 0.8});
  EXPECT_EQ(pair.restitution, 0.7);
  EXPECT_NEAR(pair.friction, 0.4, 1e-16);  // sqrt(0.16), one rounding
  EXPECT_EQ(combine({1.0, 0.0}, {0.0, 5.0}).friction, 0.0) << "ice against anything";
}

}  // namespace
}  // namespace pneuma::sim
