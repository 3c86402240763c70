#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"
#include "tests/sim/contact_worlds.h"
#include "tests/support/count_allocations.h"

namespace pneuma::sim {
namespace {

// Worlds for everything that must hold whatever a world contains.

World spheres_leaning() {
  // On a slope of five degrees the upper one leans on the lower one.
  World world;
  world.settings.gravity = {0.8, 0.0, -9.8};
  world.settings.ground->friction = 1.0;
  for (const double x : {0.5, -5.8}) {
    add(world, sphere({x, 0.0, 4.0}));
    world.soft.back().material.surface.friction = 1.0;
  }
  return world;
}

World three_spheres_piled() {
  World world;
  add(world, sphere({0.0, 0.0, 3.0}));
  add(world, sphere({7.0, 0.5, 3.0}));
  add(world, sphere({3.4, 0.0, 9.0}));
  return world;
}

World torus_with_cubes() {
  World world;
  add(world, torus(6.0, {0.0, 0.0, 2.6}));
  for (int i = 0; i < 4; ++i) {
    add(world,
        make_rigid({2.4, 2.4, 2.4}, {-1.5 + 3.0 * (i % 2), -1.4 + 3.0 * (i / 2), 6.0 + i}, 2.0));
    world.rigid.back().angular_velocity = {0.3 * i, 0.2, -0.1 * i};
  }
  return world;
}

World spheres_in_one_place() {
  World world = by_impulses();
  for (int i = 0; i < 5; ++i) add(world, sphere({0.0, 0.0, 3.5}));
  return world;
}

World searched_exactly(World world) {
  world = by_impulses(std::move(world));
  world.settings.soft_search = SoftSearch::exact;
  return world;
}

World stacked_cubes() {
  World world;
  for (int i = 0; i < 10; ++i) add(world, make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 0.5 + i}));
  return world;
}

struct NamedWorld {
  std::string name;
  std::function<World()> make;
};

void PrintTo(const NamedWorld& world, std::ostream* out) { *out << world.name; }

class AnyWorld : public testing::TestWithParam<NamedWorld> {};

INSTANTIATE_TEST_SUITE_P(
    Worlds, AnyWorld,
    testing::Values(
        NamedWorld{"meeting_spheres", [] { return meeting_spheres(4.0, 1); }},
        NamedWorld{"spheres_leaning", spheres_leaning},
        NamedWorld{"three_spheres_piled", three_spheres_piled},
        NamedWorld{"box_on_sphere", box_on_sphere}, NamedWorld{"sphere_on_box", sphere_on_box},
        NamedWorld{"sphere_in_torus", sphere_in_torus},
        NamedWorld{"spheres_in_one_place", spheres_in_one_place},
        NamedWorld{"exact_spheres_leaning", [] { return searched_exactly(spheres_leaning()); }},
        NamedWorld{"torus_with_cubes", torus_with_cubes},
        NamedWorld{"stacked_cubes", stacked_cubes},
        NamedWorld{"spheres_leaning_by_impulses", [] { return by_impulses(spheres_leaning()); }},
        NamedWorld{"sphere_in_torus_by_impulses", [] { return by_impulses(sphere_in_torus()); }},
        NamedWorld{"torus_with_cubes_by_impulses", [] { return by_impulses(torus_with_cubes()); }},
        NamedWorld{"stacked_cubes_by_impulses", [] { return by_impulses(stacked_cubes()); }}),
    [](const auto& name) { return name.param.name; });

std::uint64_t hash_after(World world, double seconds, StepperOptions options = {}) {
  EXPECT_FALSE(run(world, seconds, std::move(options)));
  return state_hash(world);
}

TEST_P(AnyWorld, HasContactsInItsFirstSeconds) {
  // Without them the tests below would say nothing about contacts.
  World world = GetParam().make();
  Stepper stepper(world);
  std::size_t between_bodies = 0;
  while (time(world) < 3.0) {
    ASSERT_FALSE(stepper.step(world));
    for (const Contact& contact : stepper.contacts()) {
      between_bodies += contact.second.kind != SideKind::ground;
    }
  }
  EXPECT_GT(between_bodies, 10U);
}

TEST_P(AnyWorld, LeavingOutWhatItDoesNotNeedChangesNoBit) {
  StepperOptions everything;
  everything.plan = make_full_plan();
  EXPECT_EQ(hash_after(GetParam().make(), 3.0, everything), hash_after(GetParam().make(), 3.0));
}

TEST_P(AnyWorld, EndsTheSameForAnyNumberOfThreadsAndTwiceInARow) {
  const std::uint64_t expected = hash_after(GetParam().make(), 3.0);
  for (const int threads : {1, 2, 3}) {
    StepperOptions options;
    options.threads = threads;
    EXPECT_EQ(hash_after(GetParam().make(), 3.0, options), expected) << threads;
  }
}

TEST_P(AnyWorld, ContinuesBitForBitFromACheckpointInTheMiddleOfContacts) {
  const std::uint64_t expected = hash_after(GetParam().make(), 3.0);
  for (const double seconds : {0.5, 1.0, 2.0}) {
    World before = GetParam().make();
    ASSERT_FALSE(run(before, seconds));
    World after = GetParam().make();
    load_state(save_state(before), after);
    EXPECT_EQ(hash_after(after, 3.0 - seconds), expected) << seconds;
  }
}

TEST_P(AnyWorld, AllocatesNothingOnceWarm) {
  World world = GetParam().make();
  Stepper stepper(world);
  while (time(world) < 20.0) ASSERT_FALSE(stepper.step(world));
  const long before = allocation_count();
  while (time(world) < 22.0) ASSERT_FALSE(stepper.step(world));
  EXPECT_EQ(allocation_count() - before, 0);
}

TEST(Pipeline, ADivergenceInContactsLeavesTheLastSoundState) {
  // The inverse of this mass is infinite, so that the first contact of the box makes numbers that
  // are not. Meanwhile two spheres meet, whose particles walk, and another box rests.
  World world = by_impulses(spheres_leaning());
  world.rigid = {make_rigid(Vec3(1.0, 1.0, 1.0), {30.0, 0.0, 0.6}, 1e-310),
                 make_rigid(Vec3(1.0, 1.0, 1.0), {20.0, 0.0, 0.5})};
  world.rigid[0].name = "feather";
  Stepper stepper(world);
  std::optional<Divergence> divergence;
  World before = world;
  for (int i = 0; i < 600 && !divergence; ++i) {
    before = world;
    divergence = stepper.step(world);
  }
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->stage, Stage::resolve_contacts);
  EXPECT_EQ(divergence->body, "feather");
  EXPECT_EQ(divergence->step, before.steps + 1);
  EXPECT_FALSE(before.particles.empty());
  EXPECT_FALSE(before.warm_start_impulses.empty());
  EXPECT_EQ(state_hash(world), state_hash(before));
}

TEST(Plan, HasWhatTheKindsOfBodiesNeed) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(left_out(make_plan(by_impulses(spheres_leaning()))),
            (Names{"integrate_rigid", "rigid_ground", "soft_rigid", "rigid_rigid"}));
  EXPECT_EQ(left_out(make_plan(by_impulses(box_on_sphere()))),
            (Names{"move_particles", "depenetrate", "soft_soft", "rigid_rigid"}));
  EXPECT_EQ(left_out(make_plan(by_impulses(stacked_cubes()))),
            (Names{"integrate_soft", "move_particles", "depenetrate", "soft_ground", "soft_soft",
                   "soft_rigid"}));
  EXPECT_EQ(left_out(make_plan(by_impulses(torus_with_cubes()))),
            (Names{"move_particles", "depenetrate", "soft_soft"}));
  const World exact = searched_exactly(spheres_leaning());
  EXPECT_EQ(left_out(make_plan(exact)), (Names{"integrate_rigid", "move_particles", "rigid_ground",
                                               "soft_rigid", "rigid_rigid"}));
  World all = by_impulses(torus_with_cubes());
  add(all, sphere({0.0, 0.0, 20.0}));
  EXPECT_EQ(left_out(make_plan(all)), Names{"depenetrate"});
  add(all, sphere({0.0, 0.0, 30.0}));
  EXPECT_EQ(left_out(make_plan(all)), Names{});
  all.settings.ground.reset();
  EXPECT_EQ(left_out(make_plan(all)), (Names{"soft_ground", "rigid_ground"}));
}

TEST(Plan, BoxesThatNothingMovesMeetNeitherTheGroundNorEachOther) {
  World world = torus_with_cubes();
  for (RigidBox& box : world.rigid) box.is_kinematic = true;
  const Plan plan = make_plan(world);
  EXPECT_FALSE(plan.runs(ContactKind::rigid_ground));
  EXPECT_FALSE(plan.runs(ContactKind::rigid_rigid));
  EXPECT_TRUE(plan.runs(ContactKind::soft_rigid));
  world.rigid[0].is_kinematic = false;
  EXPECT_TRUE(make_plan(world).runs(ContactKind::rigid_ground));
  EXPECT_TRUE(make_plan(world).runs(ContactKind::rigid_rigid));
}

TEST(Plan, OfSweptContactsHasNeitherParticlesNorBodiesMovedApart) {
  World world = torus_with_cubes();
  add(world, sphere({0.0, 0.0, 20.0}));
  add(world, sphere({0.0, 0.0, 30.0}));
  EXPECT_EQ(left_out(make_plan(world)),
            (std::vector<std::string>{"broad_phase", "move_particles", "depenetrate"}));
}

TEST(Plan, OneBodyHasNoMemoryForPairs) {
  World soft;
  add(soft, sphere({0.0, 0.0, 3.5}));
  ASSERT_FALSE(run(soft, 2.0));
  EXPECT_EQ(soft.particles.capacity(), 0U);
  EXPECT_EQ(soft.warm_start_impulses.capacity(), 0U);

  World box;
  add(box, make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 0.6}));
  EXPECT_EQ(
      left_out(make_plan(box)),
      (std::vector<std::string>{"integrate_soft", "broad_phase", "move_particles", "depenetrate",
                                "soft_ground", "soft_soft", "soft_rigid", "rigid_rigid"}));
  ASSERT_FALSE(run(box, 2.0));
  EXPECT_EQ(box.particles.capacity(), 0U);
  ASSERT_EQ(box.warm_start_impulses.size(), 8U) << "its four corners, at both ends of the step";
  const double eighth = box.rigid[0].mass * 9.81 / 60.0 / 8.0;  // of what weight gives in a step
  for (const WarmStartImpulse& resting : box.warm_start_impulses) {
    EXPECT_EQ(resting.second, -1);
    EXPECT_NEAR(resting.impulse.z(), eighth, 0.01 * eighth) << "drag is of a hundredth";
  }
}

TEST(Resting, ImpulsesAreKeptGroundFirstThenByPairs) {
  World world = by_impulses();  // three islands of two cubes
  for (int i = 0; i < 6; ++i) {
    add(world, make_rigid({1.0, 1.0, 1.0}, {3.0 * (i % 3), 0.0, 0.5 + i / 3}));
  }
  ASSERT_FALSE(run(world, 1.0));
  using Pair = std::pair<int, int>;
  std::vector<Pair> kept;
  for (const WarmStartImpulse& resting : world.warm_start_impulses) {
    kept.push_back(resting.second == -1 ? Pair(-1, resting.first)
                                        : Pair(resting.first, resting.second));
  }
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  EXPECT_EQ(kept, (std::vector<Pair>{{-1, 0}, {-1, 1}, {-1, 2}, {0, 3}, {1, 4}, {2, 5}}));
}

TEST(Resting, ImpulsesOfAStackCarryTheWeightAboveThem) {
  // In every step the impulses between two cubes carry what is above them: (10 - i) m g h each.
  World world = stacked_cubes();
  ASSERT_FALSE(run(world, 20.0));
  std::vector<double> carried(10, 0.0);
  for (const WarmStartImpulse& resting : world.warm_start_impulses) {
    // Of cubes i and i + 1 the first is the lower: it is pushed down.
    const std::size_t interface = at(resting.second == -1 ? 0 : resting.second);
    carried[interface] += std::abs(resting.impulse.z());
  }
  for (int i = 0; i < 10; ++i) {
    const double weight = (10 - i) * 9.81 / 60.0;
    // Drag takes a hundredth of a velocity in a step, and so half of that of what gravity gives
    // within it; iterations end at 1e-6.
    EXPECT_NEAR(carried[at(i)] / weight, (0.99 - 1.0) / std::log(0.99), 1e-3) << i;
  }
}

}  // namespace
}  // namespace pneuma::sim
