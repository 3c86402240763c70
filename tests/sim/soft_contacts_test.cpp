#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "sim/inspect/inspect.h"
#include "tests/sim/contact_worlds.h"

namespace pneuma::sim {
namespace {

const double skin = Settings{}.skin_thickness;

double total_mass(const World& world) {
  double mass = 0.0;
  for (const SoftBody& body : world.soft) mass += body.material.vertex_mass * body.positions.size();
  for (const RigidBox& box : world.rigid) mass += box.mass;
  return mass;
}

Vec3 centre_of_mass(const World& world) {
  Vec3 sum = Vec3::Zero();
  for (const SoftBody& body : world.soft) {
    sum += body.material.vertex_mass * body.positions.size() * mean(body.positions);
  }
  for (const RigidBox& box : world.rigid) sum += box.mass * box.position;
  return sum / total_mass(world);
}

struct Encounter {
  double penetration = 0.0;
  std::size_t contacts = 0;
};

/// Steps an isolated world and expects, in every step, the momentum to be kept and the centre of
/// mass to move evenly: not only impulses but also separation must treat both sides alike.
Encounter expect_isolated(World& world, double seconds) {
  const Vec3 momentum_before = momentum(world).linear, centre_before = centre_of_mass(world);
  Encounter encounter;
  Stepper stepper(world);
  while (time(world) < seconds) {
    EXPECT_FALSE(stepper.step(world));
    encounter.contacts += stepper.contacts().size();
    encounter.penetration = std::max(encounter.penetration, max_penetration(world));
    // Roundings of sums of about a hundred numbers of 1 kg m/s, over 600 steps.
    const Vec3 gained = momentum(world).linear - momentum_before;
    const Vec3 way = centre_of_mass(world) - centre_before;
    EXPECT_LT(gained.norm(), 1e-11);
    EXPECT_LT((way - time(world) / total_mass(world) * momentum_before).norm(), 1e-11);
    if (testing::Test::HasFailure()) break;
  }
  return encounter;
}

TEST(SoftSoft, TheExactSearchKeepsMomentumAndHoldsSpheresApartWithoutParticles) {
  for (const double speed : {1.0, 2.0, 4.0}) {
    World world = meeting_spheres(speed, 1);
    world.settings.soft_search = SoftSearch::exact;
    const Encounter encounter = expect_isolated(world, 6.0);
    EXPECT_GT(encounter.contacts, 0U);
    // Never nearer than touching: all that is within the skin is found, however fast it comes.
    EXPECT_EQ(encounter.penetration, 0.0) << speed;
    EXPECT_LT(mean(world.soft[0].velocities).x(), 0.0);
    EXPECT_GT(mean(world.soft[1].velocities).x(), 0.0);
    EXPECT_TRUE(world.particles.empty());
  }
}

TEST(SoftSoft, SpheresThatMeetBounceApartAndKeepTheirMomentum) {
  for (const double speed : {1.0, 2.0, 4.0}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      World world = meeting_spheres(speed, seed);
      const Encounter encounter = expect_isolated(world, 6.0);
      EXPECT_GT(encounter.contacts, 0U);
      EXPECT_LT(encounter.penetration, skin) << speed << " " << seed;
      EXPECT_LT(mean(world.soft[0].velocities).x(), 0.0) << "turned back";
      EXPECT_GT(mean(world.soft[1].velocities).x(), 0.0);
    }
  }
}

TEST(SoftSoft, AMovingAndARestingSphereOfOtherMassKeepTheirMomentum) {
  World world = isolated();
  add(world, sphere({-4.0, 0.0, 0.0}));
  add(world, sphere({4.0, 0.5, 0.5}));
  world.soft[1].material.vertex_mass = 3.0;
  push(world.soft[0], {4.0, 0.2, 0.0});
  const Encounter encounter = expect_isolated(world, 6.0);
  EXPECT_GT(encounter.contacts, 0U);
  EXPECT_LT(mean(world.soft[0].velocities).x(), mean(world.soft[1].velocities).x());
}

TEST(SoftRigid, ABoxAgainstASphereKeepsTheirMomentum) {
  for (const double mass : {0.5, 5.0, 50.0}) {
    World world = isolated();
    add(world, sphere({0.0, 0.0, 0.0}));
    add(world, make_rigid({2.0, 2.0, 2.0}, {0.3, 0.2, 6.0}, mass));
    world.rigid[0].velocity = {0.0, 0.0, -3.0};
    world.rigid[0].angular_velocity = {0.4, 0.3, 0.1};
    const Encounter encounter = expect_isolated(world, 5.0);
    EXPECT_GT(encounter.contacts, 0U);
    EXPECT_LT(encounter.penetration, skin) << mass;
  }
}

TEST(SoftRigid, ASphereAgainstABoxKeepsTheirMomentum) {
  for (const double mass : {5.0, 50.0}) {
    World world = isolated();
    add(world, sphere({0.2, 0.1, 7.0}));
    push(world.soft[0], {0.0, 0.0, -4.0});
    add(world, make_rigid({6.0, 6.0, 2.0}, {0.0, 0.0, 0.0}, mass));
    const Encounter encounter = expect_isolated(world, 5.0);
    EXPECT_GT(encounter.contacts, 0U);
    EXPECT_LT(encounter.penetration, skin) << mass;
  }
}

/// The greatest penetration in a run.
double penetration_of(World& world, double seconds) {
  double greatest = 0.0;
  Stepper stepper(world);
  while (time(world) < seconds) {
    if (stepper.step(world)) return std::numeric_limits<double>::infinity();
    greatest = std::max(greatest, max_penetration(world));
  }
  return greatest;
}

TEST(SoftRigid, ABoxDroppedOnASphereAndASphereDroppedOnABoxStayOutOfEachOther) {
  // Vertices and corners are kept out; an edge of the box may press between the vertices of the
  // sphere, whose edges are up to 2.3 m long, as far as its sagitta.
  World world = box_on_sphere();
  EXPECT_LT(penetration_of(world, 8.0), 0.4);
  world = sphere_on_box();
  EXPECT_LT(penetration_of(world, 8.0), 0.8);
}

TEST(SoftSoft, ASphereDroppedIntoATorusStaysInItsHole) {
  // Normals of the surfaces, not directions between nearest points, push it to the middle from all
  // sides (ERRATA row 20).
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    World world = sphere_in_torus();
    world.settings.seed = seed;
    Stepper stepper(world);
    double sideways = 0.0;
    while (time(world) < 10.0) {
      ASSERT_FALSE(stepper.step(world));
      const Vec3 way = mean(world.soft[1].positions) - mean(world.soft[0].positions);
      sideways = std::max(sideways, way.head<2>().norm());
      ASSERT_LT(std::abs(way.z()), 6.5) << "neither through it nor out of it";
    }
    EXPECT_LT(sideways, 1.5) << seed;  // the hole's radius is 4.5 m, measured: 0.3
    EXPECT_LT(energy(world).kinetic, 1.0) << seed;
    EXPECT_LT(max_penetration(world), skin) << seed;
  }
}

}  // namespace
}  // namespace pneuma::sim
