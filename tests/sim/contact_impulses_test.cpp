// What contacts are reported to have given, against the weight that they carry and the momentum
// that bodies get.
#include <gtest/gtest.h>

#include "sim/world/paper_method.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

struct Form {
  const char* name;
  ContactMethod contact;
  Integrator integrator;
  bool is_printed = false;
};

constexpr auto forms = std::to_array<Form>({
    {"swept", ContactMethod::swept, Integrator::rk4},
    {"impulses", ContactMethod::impulses, Integrator::rk4},
    {"potential", ContactMethod::potential, Integrator::implicit_euler},
    {"printed", ContactMethod::impulses, Integrator::rk4, true},
});

World world_of(const Form& form) {
  World world;
  world.settings.contact = form.contact;
  world.settings.integrator = form.integrator;
  world.settings.sleep_speed = 0.0;
  return world;
}

/// N s, of the last step.
Vec3 sum_of_impulses(const Stepper& stepper) {
  Vec3 sum = Vec3::Zero();
  for (const Contact& contact : stepper.contacts()) sum += contact.impulse;
  return sum;
}

TEST(ContactImpulses, OfABoxAtRestAreItsWeightTimesTheStep) {
  for (const Form& form : forms) {
    World world = world_of(form);
    world.rigid.push_back(make_rigid({1.0, 1.5, 0.8}, {0.0, 0.0, 0.4}, 3.0));
    world.rigid[0].rho_g = 0.0;  // drag would carry a part
    if (form.is_printed) use_paper_method(world);
    Stepper stepper(world);
    Vec3 sum = Vec3::Zero();
    constexpr int steps = 120;
    for (int i = 0; i < 10 * steps; ++i) {
      ASSERT_FALSE(stepper.step(world)) << form.name;
      if (i >= 9 * steps) sum += sum_of_impulses(stepper) / steps;
    }
    const double expected = 3.0 * 9.81 * time_step(world.settings);
    EXPECT_NEAR(sum.z(), expected, 0.001 * expected) << form.name;
    EXPECT_LT(sum.head<2>().norm(), 0.01 * expected) << form.name;
  }
}

TEST(ContactImpulses, OfASoftBodyAtRestAreItsWeightTimesTheStep) {
  for (const Form& form : forms) {
    if (form.is_printed) continue;  // its damping takes momentum
    World world = world_of(form);
    world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 3.0}));
    world.soft[0].material.k = 200.0;
    world.soft[0].material.n = 1.0;
    Stepper stepper(world);
    double sum = 0.0;
    constexpr int steps = 600;
    for (int i = 0; i < 4 * steps; ++i) {
      ASSERT_FALSE(stepper.step(world)) << form.name;
      if (i >= 3 * steps) sum += sum_of_impulses(stepper).z() / steps;
    }
    const SoftBody& body = world.soft[0];
    const double mass = body.material.vertex_mass * static_cast<double>(body.positions.size());
    const double expected = mass * 9.81 * time_step(world.settings);
    EXPECT_NEAR(sum, expected, 0.03 * expected) << form.name;
  }
}

/// Without gravity and friction of the air a box that meets a ball gets nothing but the impulses,
/// step by step, along whatever line and however often the step is divided.
TEST(ContactImpulses, AreTheMomentumThatABoxGets) {
  for (const Form& form : {Form{"rk4", ContactMethod::swept, Integrator::rk4},
                           Form{"implicit_euler", ContactMethod::swept, Integrator::implicit_euler},
                           Form{"impulses", ContactMethod::impulses, Integrator::rk4}}) {
    World world = world_of(form);
    world.settings.gravity.setZero();
    world.settings.ground.reset();
    world.soft.push_back(make_body(make_sphere(3.0, 8, 8)));
    world.rigid.push_back(make_rigid({2.0, 1.0, 1.5}, {5.0, 0.7, 0.4}, 5.0));
    world.rigid[0].rho_g = 0.0;
    world.rigid[0].velocity = {-4.0, 0.0, 0.0};
    Stepper stepper(world);
    double given = 0.0;
    for (int i = 0; i < 120; ++i) {
      const Vec3 before = world.rigid[0].velocity;
      ASSERT_FALSE(stepper.step(world)) << form.name;
      Vec3 on_box = Vec3::Zero();
      for (const Contact& contact : stepper.contacts()) {
        on_box += contact.first.kind == SideKind::rigid ? contact.impulse : -contact.impulse;
      }
      const Vec3 got = 5.0 * (world.rigid[0].velocity - before);
      EXPECT_LT((on_box - got).norm(), 1e-10) << form.name << ", step " << i;
      given += got.norm();
    }
    EXPECT_GT(given, 20.0) << form.name << " stops the box: 5 kg at 4 m/s";
  }
}

/// Of a box on another the lower one gets what the upper one is given.
TEST(ContactImpulses, ActOnTheFirstSide) {
  for (const Form& form : forms) {
    if (form.is_printed) continue;  // its boxes are not held apart at rest
    World world = world_of(form);
    world.rigid.push_back(make_rigid({2.0, 2.0, 1.0}, {0.0, 0.0, 0.5}, 4.0));
    world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 1.51}, 1.0));
    Stepper stepper(world);
    Vec3 on_upper = Vec3::Zero();
    constexpr int steps = 120;
    for (int i = 0; i < 10 * steps; ++i) {
      ASSERT_FALSE(stepper.step(world)) << form.name;
      if (i < 9 * steps) continue;
      for (const Contact& contact : stepper.contacts()) {
        if (contact.second.kind == SideKind::ground) continue;
        on_upper += (contact.first.body == 1 ? 1.0 : -1.0) / steps * contact.impulse;
      }
    }
    const double expected = 1.0 * 9.81 * time_step(world.settings);
    EXPECT_NEAR(on_upper.z(), expected, 0.02 * expected) << form.name;
  }
}

}  // namespace
}  // namespace pneuma::sim
