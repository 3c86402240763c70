#include "app/world/step_advice.h"

#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "sim/step/stepper.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

/// A ball that lies on the ground, its contact a potential.
sim::World lying_ball() {
  sim::World world;
  world.settings.contact = sim::ContactMethod::potential;
  world.settings.integrator = sim::Integrator::implicit_euler;
  world.settings.steps_per_second = 60;
  world.settings.ground = sim::ContactMaterial{0.2, 0.5};
  world.soft.push_back(sim::make_body(sim::make_icosphere(1.0, 1), {0.0, 0.0, 1.02}));
  world.soft[0].material.k = 200.0;
  world.soft[0].material.n = 0.05;
  world.soft[0].material.vertex_mass = 0.1;
  EXPECT_FALSE(sim::run(world, 3.0));
  world.settings.integrator = sim::Integrator::rk4;
  return world;
}

TEST(StepAdviceInContact, IsThatOfWhatIsStiffest) {
  sim::World world = lying_ball();
  const sim::SoftBody& ball = world.soft[0];
  const StepAdvice alone = step_advice(world, ball);
  const StepAdvice touching = step_advice_in_contact(world, ball);
  EXPECT_FALSE(alone.of_contact);
  EXPECT_TRUE(touching.of_contact);
  // A vertex that carries a good part of the ball, 2 mu lambda / v_0 against its mass.
  EXPECT_LT(touching.limit, 0.2 * alone.limit);
  EXPECT_GT(touching.steps_per_second, 1.0 / touching.limit);
  EXPECT_NE(remedy(touching).find("contact by potential with rk4"), std::string::npos);

  world.soft[0].positions.rows().row(2).array() += 1.0;  // in the air
  EXPECT_FALSE(step_advice_in_contact(world, ball).of_contact);
  world.soft[0].positions.rows().row(2).array() -= 2.0;  // in the ground
  EXPECT_FALSE(step_advice_in_contact(world, ball).of_contact);
}

TEST(StepAdviceInContact, IsThatOfTheBodyForOtherContacts) {
  sim::World world = lying_ball();
  world.settings.contact = sim::ContactMethod::swept;
  EXPECT_EQ(step_advice_in_contact(world, world.soft[0]).limit,
            step_advice(world, world.soft[0]).limit);
}

/// Contacts shake what lies on others nearer to the limit.
TEST(StepAdvice, IsOfShorterStepsWhereBodiesMayMeet) {
  sim::World world = lying_ball();
  const double alone = step_advice(world, world.soft[0]).safe;
  world.rigid.push_back(sim::make_rigid(sim::Vec3::Ones(), {9.0, 0.0, 0.5}));
  world.rigid[0].is_kinematic = true;
  EXPECT_EQ(step_advice(world, world.soft[0]).safe, alone);
  world.rigid[0].is_kinematic = false;
  EXPECT_NEAR(step_advice(world, world.soft[0]).safe, 0.75 / 0.9 * alone, 1e-12);
}

/// Whose hits divide steps: by rk4 these commute.
TEST(StepAdvice, IsOfLessThanHalfTheLimitBesideBoxesWhereStepsDoNotCommute) {
  sim::World world = lying_ball();
  world.settings.contact = sim::ContactMethod::swept;
  world.rigid.push_back(sim::make_rigid(sim::Vec3::Ones(), {9.0, 0.0, 0.5}));
  const auto share = [&](sim::Integrator integrator) {
    world.settings.integrator = integrator;
    const StepAdvice advice = step_advice(world, world.soft[0]);
    return advice.safe / advice.limit;
  };
  EXPECT_DOUBLE_EQ(share(sim::Integrator::rk4), 0.75);
  EXPECT_DOUBLE_EQ(share(sim::Integrator::velocity_verlet), 0.45);
  EXPECT_DOUBLE_EQ(share(sim::Integrator::symplectic_euler), 0.45);
  world.rigid[0].is_kinematic = true;
  EXPECT_DOUBLE_EQ(share(sim::Integrator::velocity_verlet), 0.9);
}

/// By which contacts, at the ends of a step, would win energy.
TEST(StepAdvice, IsOfNoLongerStepsByRk8ThanByRk4WhereBodiesMayTouch) {
  sim::World world = lying_ball();
  const auto ground = std::exchange(world.settings.ground, std::nullopt);
  const auto safe = [&](sim::Integrator integrator) {
    world.settings.integrator = integrator;
    return step_advice(world, world.soft[0]).safe;
  };
  EXPECT_GT(safe(sim::Integrator::rk8), 1.3 * safe(sim::Integrator::rk4));
  world.rigid.push_back(sim::make_rigid(sim::Vec3::Ones(), {9.0, 0.0, 0.5}));
  EXPECT_DOUBLE_EQ(safe(sim::Integrator::rk8), safe(sim::Integrator::rk4));
  world.rigid.clear();
  world.settings.ground = ground;
  EXPECT_DOUBLE_EQ(safe(sim::Integrator::rk8), safe(sim::Integrator::rk4));
}

/// Springs between bodies are stepped explicitly by implicit integrators too.
TEST(StepAdvice, NamesTheSpringThatIsTooStiff) {
  sim::World world = lying_ball();
  world.soft.push_back(sim::make_body(sim::make_icosphere(1.0, 1), {4.0, 0.0, 1.02}));
  world.soft[1].mesh = world.soft[0].mesh;
  world.soft[1].material = world.soft[0].material;
  world.soft[1].name = "other";
  world.soft.push_back(world.soft[1]);
  world.springs = {{{1, {3}}, {2, {5}}, 1e6, 0.0, 1.0}};
  for (const sim::Integrator integrator : {sim::Integrator::rk4, sim::Integrator::sdirk2}) {
    world.settings.integrator = integrator;
    const std::vector<StepAdvice> advices = step_advices(world);
    ASSERT_EQ(advices.size(), 3u);  // all alike, and the two that the spring joins
    EXPECT_FALSE(advices[0].too_long());
    EXPECT_TRUE(advices[1].of_springs);
    EXPECT_TRUE(advices[2].too_long());
    const std::string warning = step_warning(advices[2]);
    EXPECT_NE(warning.find("[[spring]] from 'other' to"), std::string::npos) << warning;
    EXPECT_NE(warning.find("k = 1e+06 N/m"), std::string::npos) << warning;
    EXPECT_EQ(warning.find("implicit_euler"), std::string::npos) << warning;
  }
}

}  // namespace
}  // namespace pneuma::app
