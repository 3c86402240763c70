// Impacts of boxes that meet nothing else in a step.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/rotation.h"
#include "sim/world/sleep.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// A box that turns, and hits the flat top of another with one corner.
World turning_box(const RigidBox& below, int steps_per_second) {
  World world = make_free_boxes({make_rigid({1.0, 1.2, 0.8}, {0.2, 0.1, 1.3}, 2.0), below}, 0.8);
  world.settings.contact = ContactMethod::swept;
  world.settings.steps_per_second = steps_per_second;
  for (RigidBox& box : world.rigid) box.surface.friction = 0.3;
  world.rigid[0].orientation = rotation_of_degrees({30.0, 40.0, 0.0});
  world.rigid[0].velocity = {2.0, -1.0, -4.0};
  world.rigid[0].angular_velocity = {3.0, 2.0, -1.0};
  return world;
}

TEST(FreeImpact, OfABoxThatTurnsIsTheSameAtEveryStep) {
  const RigidBox below = make_rigid({6.0, 6.0, 1.0}, {0.0, 0.0, -0.5}, 5.0);
  World fine = turning_box(below, 15360);
  ASSERT_FALSE(run(fine, 0.4));
  EXPECT_GT(fine.rigid[0].velocity.z(), 0.2);
  for (const int steps_per_second : {60, 240, 960}) {
    World world = turning_box(below, steps_per_second);
    const Momentum before = momentum(world);
    const double kinetic = energy(world).kinetic;
    Stepper stepper(world, {.measure_work = true, .plan = {}});
    double work = 0.0;
    while (time(world) < 0.4) {
      ASSERT_FALSE(stepper.step(world));
      work += stepper.contact_work();
      EXPECT_LE(stepper.contact_work(), 1e-12 * kinetic);
    }
    // Where steps are short the box is near before it is hit, and hit at the end of the step.
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LT((world.rigid[i].velocity - fine.rigid[i].velocity).norm(), 0.01 * 4.0) << i;
      EXPECT_LT((world.rigid[i].position - fine.rigid[i].position).norm(), 0.01 * 4.0 * 0.4) << i;
    }
    EXPECT_LT((momentum(world).linear - before.linear).norm(), 1e-13 * before.linear.norm());
    EXPECT_LT((momentum(world).angular - before.angular).norm(), 1e-12 * before.angular.norm());
    // But for what turning freely changes.
    EXPECT_NEAR(energy(world).kinetic - kinetic, work, 1e-3 * kinetic);
  }
}

TEST(FreeImpact, OnABoxThatStandsStillIsThatOnTheGround) {
  RigidBox below = make_rigid({6.0, 6.0, 1.0}, {0.0, 0.0, -0.5}, 5.0);
  below.position.z() -= 0.0025 * (0.8 + 1.0);  // boxes keep their skins apart
  below.is_kinematic = true;
  World on_box = turning_box(below, 60), on_ground = turning_box(below, 60);
  World other_way = turning_box(below, 60);
  std::swap(other_way.rigid[0], other_way.rigid[1]);
  on_ground.rigid.pop_back();
  on_ground.settings.ground = ContactMaterial{0.8, 0.3};
  for (World* world : {&on_box, &other_way, &on_ground}) ASSERT_FALSE(run(*world, 0.4));
  EXPECT_GT(on_ground.rigid[0].velocity.z(), 0.3);
  // The moment is found to a twentieth of a skin.
  EXPECT_LT((on_box.rigid[0].velocity - on_ground.rigid[0].velocity).norm(), 1e-3 * 4.0);
  EXPECT_EQ(on_box.rigid[0].velocity, other_way.rigid[1].velocity);
}

/// A flight keeps its energy: all that changes is the work of contacts.
TEST(FreeImpact, BooksItsWork) {
  int hits = 0;
  for (int i = 0; i < 40; ++i) {
    World world = turning_box(make_rigid(Vec3::Ones(), {50.0, 0.0, 50.0}, 1.0), 60);
    world.settings.ground = ContactMaterial{0.8, 0.3};
    world.settings.gravity = {0.0, 0.0, -9.81};
    world.rigid.resize(1);
    world.rigid[0].size = Vec3::Ones();
    world.rigid[0].position.z() += 0.01 * i;
    Stepper stepper(world, {.measure_work = true, .plan = {}});
    for (int step = 0; step < 30 && stepper.contacts().empty(); ++step) {
      const double before = energy(world).total();
      ASSERT_FALSE(stepper.step(world));
      hits += stepper.contacts().empty() ? 0 : 1;
      EXPECT_NEAR(energy(world).total() - before, stepper.contact_work(), 1e-12 * 40.0);
    }
  }
  EXPECT_EQ(hits, 40);
}

/// A box that falls close beside another, which stands still, is stopped on the ground until the
/// end of the step. What gravity adds until then does not bounce.
TEST(FreeImpact, BesideAnotherBodyReturnsNoMore) {
  constexpr double restitution = 0.9, gravity = 9.81;
  for (int i = 0; i < 20; ++i) {
    const double height = 1.0 + 0.05 * i;
    RigidBox post = make_rigid({0.2, 2.0, 8.0}, {0.63, 0.0, 4.1}, 1.0);
    post.is_kinematic = true;
    World world =
        make_free_boxes({make_rigid(Vec3::Ones(), {0.0, 0.0, 0.5 + height}, 1.0), post}, 0.9);
    world.settings.contact = ContactMethod::swept;
    world.settings.steps_per_second = 60;
    world.settings.gravity = {0.0, 0.0, -gravity};
    world.settings.ground = ContactMaterial{restitution, 0.5};
    for (RigidBox& box : world.rigid) box.surface.friction = 0.5;
    Stepper stepper(world);
    while (world.rigid[0].velocity.z() <= 0.0) ASSERT_FALSE(stepper.step(world));
    const RigidBox& box = world.rigid[0];
    const double returned = gravity * (box.position.z() - 0.5) + 0.5 * box.velocity.squaredNorm();
    EXPECT_NEAR(returned, restitution * restitution * gravity * height, 0.02 * gravity * height);
  }
}

/// Wherever in its step the hit begins: the corners of faces that meet differ by what is left of
/// the solutions before, and one that is hit before the others would turn both boxes.
TEST(FreeImpact, FacesThatMeetDoNotTurn) {
  for (int i = 0; i < 25; ++i) {
    std::vector<RigidBox> row;
    for (int box = 0; box < 3; ++box) {
      row.push_back(make_rigid(Vec3::Ones(), {1.5 * box, 0.0, 0.0}, 1.0));
    }
    row.push_back(make_rigid(Vec3::Ones(), {-2.0 - 1e-4 * i, 0.0, 0.0}, 1.0));
    row.back().velocity = {3.0, 0.0, 0.0};
    World world = make_free_boxes(row, 1.0);
    world.settings.contact = ContactMethod::swept;
    world.settings.steps_per_second = 1200;
    ASSERT_FALSE(run(world, 1.2));
    EXPECT_NEAR(world.rigid[2].velocity.x(), 3.0, 1e-3) << i;
    for (const RigidBox& box : world.rigid) EXPECT_LT(box.angular_velocity.norm(), 1e-4) << i;
  }
}

/// Of a row of boxes, with gaps that the first crosses in a part of a step, one after the other is
/// hit, and the last leaves alone.
TEST(FreeImpact, ARowIsHitOneAfterTheOther) {
  for (const double gap : {0.01, 0.02, 0.05, 0.3}) {
    std::vector<RigidBox> row;
    for (int box = 0; box < 5; ++box) {
      row.push_back(make_rigid(Vec3::Ones(), {(1.0 + gap) * box, 0.0, 0.0}, 1.0));
    }
    row.push_back(make_rigid(Vec3::Ones(), {-2.0, 0.0, 0.0}, 1.0));
    row.back().velocity = {3.0, 0.0, 0.0};
    World world = make_free_boxes(row, 1.0);
    world.settings.contact = ContactMethod::swept;
    world.settings.steps_per_second = 60;
    ASSERT_FALSE(run(world, 1.5));
    EXPECT_NEAR(world.rigid[4].velocity.x(), 3.0, 1e-3) << gap;
  }
}

/// What lands in one step and bounces in the next would do so for ever.
TEST(FreeImpact, BouncesEnd) {
  for (const double restitution : {0.2, 0.5}) {
    World world = make_free_boxes({make_rigid(Vec3::Ones(), {0.0, 0.0, 2.0}, 1.0)}, restitution);
    world.settings.contact = ContactMethod::swept;
    world.settings.steps_per_second = 30;
    world.settings.gravity = {0.0, 0.0, -9.81};
    world.settings.ground = ContactMaterial{restitution, 0.5};
    ASSERT_FALSE(run(world, 8.0));
    EXPECT_TRUE(is_asleep(world, 0)) << restitution;
  }
}

/// Two boxes that touch and one beside them fly as one, on a parabola.
TEST(FreeFlight, OfBoxesThatTouchIsThatOfTheOthers) {
  World world = make_free_boxes({make_rigid(Vec3::Ones(), {0.0, 0.0, 0.0}, 1.0),
                                 make_rigid(Vec3::Ones(), {0.0, 0.0, 1.01}, 1.0),
                                 make_rigid(Vec3::Ones(), {0.0, 0.0, 2.12}, 1.0)},
                                0.0);
  world.settings.contact = ContactMethod::swept;
  world.settings.gravity = {0.0, 0.0, -9.81};
  const double before = energy(world).total();
  ASSERT_FALSE(run(world, 2.0));
  for (int i = 0; i < 3; ++i) {
    const double start = i == 0 ? 0.0 : i == 1 ? 1.01 : 2.12;
    EXPECT_NEAR(world.rigid[at(i)].position.z(), start - 0.5 * 9.81 * 4.0, 1e-9) << i;
  }
  EXPECT_NEAR(energy(world).total(), before, 1e-9);
}

TEST(FreeImpact, LeavesWhatAirTakes) {
  World free = turning_box(make_rigid(Vec3::Ones(), {50.0, 0.0, 50.0}, 1.0), 60);
  free.settings.ground = ContactMaterial{0.8, 0.3};
  RigidBox& box = free.rigid[0];
  const Mat3 axes = box.orientation.toRotationMatrix();
  box.position.z() = 0.5 * axes.row(2).cwiseAbs().dot(box.size) + 0.03;
  World slowed = free;
  slowed.rigid[0].rho_g = 0.3;
  ASSERT_FALSE(run(free, 1.0 / 60.0));
  ASSERT_FALSE(run(slowed, 1.0 / 60.0));
  EXPECT_GT(free.rigid[0].velocity.z(), 0.0);
  EXPECT_LT((slowed.rigid[0].velocity - 0.7 * free.rigid[0].velocity).norm(), 1e-12);
  EXPECT_LT((slowed.rigid[0].angular_velocity - 0.7 * free.rigid[0].angular_velocity).norm(),
            1e-12);
}

TEST(FreeImpact, BoxesThatPassFeelNothing) {
  for (const double speed : {5.0, 10.0, 30.0}) {
    for (const double gap : {0.02, 0.05, 0.1}) {
      for (int i = 0; i < 20; ++i) {
        const double start = -2.5 + speed / 60.0 * i / 20.0;
        World world = make_free_boxes({make_rigid(Vec3::Ones(), {start, 0.03, 1.0 + gap}, 2.0),
                                       make_rigid(Vec3::Ones(), Vec3::Zero(), 2.0)},
                                      0.8);
        world.settings.contact = ContactMethod::swept;
        for (RigidBox& box : world.rigid) box.surface.friction = 0.3;
        world.rigid[0].velocity.x() = speed;
        ASSERT_FALSE(run(world, 5.0 / speed));
        EXPECT_EQ(world.rigid[0].velocity, Vec3(speed, 0.0, 0.0)) << speed << " " << gap;
        EXPECT_EQ(world.rigid[1].velocity, Vec3(0.0, 0.0, 0.0)) << speed << " " << gap;
      }
    }
  }
}

class RandomBoxes {
 public:
  explicit RandomBoxes(unsigned seed) : random_(seed) {}

  double any(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  Vec3 any_vector() { return {any(-1.0, 1.0), any(-1.0, 1.0), any(-1.0, 1.0)}; }
  RigidBox box(const Vec3& size, const Vec3& position, const Vec3& velocity, double turn) {
    RigidBox result = make_rigid(size, position, any(0.1, 5.0));
    result.orientation = rotation_of_degrees(180.0 * any_vector());
    result.velocity = velocity;
    result.angular_velocity = any(0.0, turn) * any_vector();
    return result;
  }
  World world(const std::vector<RigidBox>& boxes) {
    World result = make_free_boxes(boxes, any(0.05, 1.0));
    result.settings.contact = ContactMethod::swept;
    result.settings.steps_per_second = any(0.0, 1.0) < 0.5 ? 30 : 60;
    const double friction = any(0.0, 1.0) < 0.3 ? 0.0 : any(0.0, 2.0);
    for (RigidBox& each : result.rigid) each.surface.friction = friction;
    result.settings.ground = result.rigid[0].surface;
    return result;
  }

 private:
  std::mt19937 random_;
};

/// Thin boxes at 5 to 200 m/s against a plate.
TEST(FreeImpact, NothingPassesAPlate) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    RandomBoxes random(seed);
    const Vec3 size(random.any(0.02, 0.5), random.any(0.2, 0.6), random.any(0.01, 0.05));
    const Vec3 at(random.any(-1.0, 1.0), random.any(-1.0, 1.0), random.any(0.5, 3.0));
    const Vec3 velocity = 5.0 * random.any_vector() - random.any(5.0, 200.0) * Vec3::UnitZ();
    const RigidBox bullet = random.box(size, at, velocity, 100.0);
    World world =
        random.world({bullet, make_rigid({6.0, 6.0, random.any(0.01, 0.1)}, Vec3::Zero(), 20.0)});
    world.settings.ground.reset();
    Stepper stepper(world);
    for (int step = 0; step < 30; ++step) {
      if (stepper.step(world)) break;
      const RigidBox& plate = world.rigid[1];
      const Vec3 local = plate.orientation.conjugate() * (world.rigid[0].position - plate.position);
      if (std::hypot(local.x(), local.y()) > 2.5) break;  // beside it
      ASSERT_GT(local.z(), 0.0) << seed << " in step " << step;
      ASSERT_EQ(crossings(world).between_bodies, 0) << seed << " in step " << step;
    }
  }
}

/// Six boxes that fall beside each other and hit the ground and their neighbours.
TEST(FreeImpact, LeavesNoBoxInAnother) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    RandomBoxes random(seed);
    std::vector<RigidBox> boxes;
    for (int i = 0; i < 6; ++i) {
      const Vec3 size(random.any(0.3, 1.0), random.any(0.3, 1.0), random.any(0.1, 1.0));
      const Vec3 at(1.9 * (i % 3 - 1), 1.9 * (i / 3), random.any(1.0, 2.0));
      Vec3 velocity = random.any(1.0, 40.0) * random.any_vector();
      velocity.z() = -std::abs(velocity.z());
      boxes.push_back(random.box(size, at, velocity, 30.0));
    }
    World world = random.world(boxes);
    if (crossings(world).between_bodies > 0) continue;
    Stepper stepper(world);
    for (int step = 0; step < 40; ++step) {
      const auto divergence = stepper.step(world);
      ASSERT_FALSE(divergence) << seed << ": " << divergence->what;
      ASSERT_EQ(crossings(world).between_bodies, 0) << seed << " in step " << step;
    }
  }
}

}  // namespace
}  // namespace pneuma::sim
