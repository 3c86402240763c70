// Boxes that keep all of their speed where they bounce, or most of it, with swept contacts (ERRATA
// row 67).
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "sim/inspect/inspect.h"
#include "tests/sim/swept/swept_worlds.h"

namespace pneuma::sim {
namespace {

RigidBox elastic_box(const Vec3& size, const Vec3& position) {
  RigidBox box = make_rigid(size, position);
  box.surface = {1.0, 0.0};
  box.rho_g = 0.0;
  return box;
}

World weightless(int steps_per_second) {
  World world = make_swept_world();
  world.settings.gravity = Vec3::Zero();
  world.settings.ground.reset();
  world.settings.steps_per_second = steps_per_second;
  return world;
}

/// What a run leaves of the energy at its start, and its greatest rise in a step.
struct EnergyLeft {
  double share = 0.0;
  double rise = 0.0;  // of that at the start
};

EnergyLeft energy_left(World world, double seconds) {
  const double start = energy(world).kinetic;
  Stepper stepper(world);
  double last = start, rise = 0.0;
  while (time(world) < seconds) {
    const auto divergence = stepper.step(world);
    EXPECT_FALSE(divergence) << divergence->what;
    const double now = energy(world).kinetic;
    rise = std::max(rise, now - last);
    last = now;
  }
  return {last / start, rise / start};
}

/// The boxes turn until corners meet as well: some steps end while they are near and approach.
TEST(ElasticBoxes, HitEachOtherTwice) {
  for (const int steps_per_second : {30, 60, 90, 120, 240, 480}) {
    for (const double aside : {0.0, 0.2, 0.4, 0.6}) {
      World world = weightless(steps_per_second);
      world.rigid.push_back(elastic_box(Vec3::Ones(), Vec3::Zero()));
      world.rigid.push_back(elastic_box(Vec3::Ones(), {-4.0, 0.3, aside}));
      world.rigid[1].velocity = {6.0, 0.0, 0.0};
      const EnergyLeft left = energy_left(world, 3.0);
      EXPECT_NEAR(left.share, 1.0, 1e-5) << steps_per_second << " " << aside;
    }
  }
}

/// A closed room: boxes hit walls and each other, several in a step.
World make_room(unsigned seed, int steps_per_second) {
  World world = weightless(steps_per_second);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 size = Vec3::Constant(9.0), place = Vec3::Zero();
      size[axis] = 0.5;
      place[axis] = 4.25 * side;
      world.rigid.push_back(elastic_box(size, place));
      world.rigid.back().is_kinematic = true;
    }
  }
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anything(-1.0, 1.0);
  const auto vector = [&] { return Vec3(anything(random), anything(random), anything(random)); };
  for (int i = 0; i < 8; ++i) {
    const Vec3 place =
        1.7 * Vec3(i % 2 == 0 ? 1.0 : -1.0, i / 2 % 2 == 0 ? 1.0 : -1.0, i / 4 == 0 ? 1.0 : -1.0);
    RigidBox box = elastic_box(Vec3::Constant(0.8) + 0.3 * vector(), place);
    box.velocity = 4.0 * vector();
    box.angular_velocity = 2.0 * vector();
    world.rigid.push_back(box);
  }
  return world;
}

TEST(ElasticBoxes, KeepTheirEnergyInARoom) {
  for (const int steps_per_second : {60, 240}) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const EnergyLeft left = energy_left(make_room(seed, steps_per_second), 12.0);
      // Some impacts at 60 steps per second are told apart to a 32nd of a step only.
      EXPECT_GT(left.share, steps_per_second == 60 ? 0.99 : 0.999) << seed;
      EXPECT_LT(left.rise, 1e-5) << seed;
    }
  }
}

/// They touch, and are hit at once: what the first impact gives is no speed to bounce with.
TEST(ElasticBoxes, InARowKeepTheirEnergy) {
  for (const int steps_per_second : {30, 60, 120, 240}) {
    World world = weightless(steps_per_second);
    for (int i = 0; i < 5; ++i) {
      world.rigid.push_back(elastic_box(Vec3::Ones(), {1.0 * i, 0.0, 0.0}));
    }
    world.rigid.push_back(elastic_box(Vec3::Ones(), {-3.0, 0.0, 0.0}));
    world.rigid.back().velocity = {4.0, 0.0, 0.0};
    EXPECT_NEAR(energy_left(world, 3.0).share, 1.0, 1e-5) << steps_per_second;
  }
}

/// Some of the speed with which they come down is that of the step's fall: given back again and
/// again it would let them hop by a centimetre for ever. One in twenty still does by less than half
/// a millimetre.
TEST(BouncyBoxes, ComeToRest) {
  const double unseen = 1.0 * 9.81 * 0.0005;  // J, of 1 kg
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anything(-1.0, 1.0);
  for (const double restitution : {0.7, 0.9, 0.95}) {
    for (const int steps_per_second : {60, 120, 240, 480}) {
      for (int drop = 0; drop < 4; ++drop) {
        World world = make_swept_world();
        world.settings.steps_per_second = steps_per_second;
        world.settings.ground = ContactMaterial{restitution, 0.5};
        const Vec3 axis(anything(random), anything(random), anything(random));
        world.rigid.push_back(make_rigid({1.0, 0.8, 0.6}, {0.0, 0.0, 2.0}));
        world.rigid[0].orientation =
            Eigen::Quaterniond(Eigen::AngleAxisd(3.0 * anything(random), axis.normalized()));
        world.rigid[0].surface = {restitution, 0.5};
        ASSERT_FALSE(run(world, 12.0));
        EXPECT_LT(energy(world).kinetic, unseen)
            << restitution << " " << steps_per_second << " " << drop;
      }
    }
  }
}

/// A stack that is dropped, each box a little above the next.
TEST(BouncyBoxes, OfAStackComeToRest) {
  for (const double restitution : {0.5, 0.8}) {
    World world = make_swept_world();
    world.settings.steps_per_second = 60;
    world.settings.ground = ContactMaterial{restitution, 0.5};
    for (int i = 0; i < 3; ++i) {
      world.rigid.push_back(make_rigid(Vec3::Ones(), {0.0, 0.0, 0.6 + 1.1 * i}));
      world.rigid.back().surface = {restitution, 0.5};
    }
    ASSERT_FALSE(run(world, 10.0));
    EXPECT_LT(energy(world).kinetic, 1e-9) << restitution;
  }
}

/// Cubes turned at random, and each a little beside its place, over the ground.
World make_crowd(int across, const ContactMaterial& surface) {
  World world = make_swept_world();
  world.settings.ground = surface;
  world.settings.steps_per_second = 60;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < across * across * across; ++i) {
    Vec3 beside;
    Eigen::Vector4d turn;
    for (double& number : beside) number = 0.13 * any(random);  // one after the other, so that
    for (double& number : turn) number = any(random);           // every compiler draws the same
    const Vec3 place(i % across, i / across % across, i / (across * across));
    world.rigid.push_back(elastic_box(Vec3::Ones(), 2.0 * place + 3.0 * Vec3::UnitZ() + beside));
    world.rigid.back().orientation = Eigen::Quaterniond(turn.normalized());
    world.rigid.back().surface = surface;
  }
  return world;
}

/// Each box meets a few others in most steps, and is near more.
TEST(ElasticBoxes, InACrowdKeepTheirEnergy) {
  World world = make_crowd(5, {1.0, 0.0});
  const double before = energy(world).total();
  Stepper stepper(world);
  while (time(world) < 4.0) ASSERT_FALSE(stepper.step(world));
  EXPECT_GT(energy(world).total(), 0.97 * before);
  EXPECT_LT(energy(world).total(), (1.0 + 1e-6) * before);
}

int parts_of_steps(World world, double seconds) {
  int parts = 0;
  StepperOptions options;
  options.after_part = [&](const World&) { ++parts; };
  Stepper stepper(world, options);
  while (time(world) < seconds) EXPECT_FALSE(stepper.step(world));
  return parts;
}

/// All of its steps would be halved for an energy that the others lose.
TEST(ElasticBoxes, OneAloneDoesNotHalveTheStepsOfACrowd) {
  const World lossy = make_crowd(4, {0.6, 0.0});
  World with_one = lossy;
  with_one.rigid.front().surface.restitution = 1.0;
  // Other motions take up to twice as many; if all were halved, four times.
  EXPECT_LT(parts_of_steps(with_one, 2.0), 2.5 * parts_of_steps(lossy, 2.0));
}

}  // namespace
}  // namespace pneuma::sim
