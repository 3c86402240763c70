// What a run that diverges says of the step.
#include "app/world/simulation.h"

#include <gtest/gtest.h>

#include "app/check/run_statistics.h"
#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

using sim::ContactMethod;
using sim::Stage;

std::string message(ContactMethod contact, Stage stage) {
  sim::World world;
  world.settings.contact = contact;
  world.soft.push_back(sim::make_body(sim::make_sphere(3.0, 8, 8), {0.0, 0.0, 3.0}));
  world.soft[0].name = "ball";
  return divergence_error("scene", {stage, 7, "ball", "it broke"}, world).what();
}

TEST(DivergenceError, NamesAStableStepUnlessShorterOnesHaveFailed) {
  for (const ContactMethod contact : {ContactMethod::impulses, ContactMethod::swept}) {
    for (const Stage stage : {Stage::integrate_soft, Stage::resolve_contacts}) {
      const std::string text = message(contact, stage);
      EXPECT_NE(text.find("body ball: it broke"), std::string::npos) << text;
      const bool halved = contact == ContactMethod::swept && stage == Stage::resolve_contacts;
      EXPECT_EQ(text.find("a step of ") == std::string::npos, halved) << text;
    }
  }
}

TEST(DivergenceError, NamesWhatIsNear) {
  sim::World world;
  world.soft.push_back(sim::make_body(sim::make_sphere(3.0, 8, 8), {0.0, 0.0, 3.0}));
  world.soft[0].name = "ball";
  for (const double x : {3.5, -3.5, 9.0}) {
    world.rigid.push_back(sim::make_rigid({1.0, 1.0, 1.0}, {x, 0.0, 3.0}, 1.0));
    world.rigid.back().name = x > 5.0 ? "far" : x > 0.0 ? "right" : "left";
  }
  const auto said = [&](const char* body) -> std::string {
    return divergence_error("scene", {Stage::resolve_contacts, 7, body, "it broke"}, world).what();
  };
  EXPECT_NE(said("ball").find("it broke; near it are right, left and the ground"),
            std::string::npos)
      << said("ball");
  EXPECT_NE(said("right").find("; near it is ball"), std::string::npos) << said("right");
  EXPECT_EQ(said("far").find("near"), std::string::npos) << said("far");
  const auto said_of_two = [&](const char* body, const char* other) -> std::string {
    sim::Divergence divergence{Stage::resolve_contacts, 7, body, "it met another"};
    divergence.other = other;
    return divergence_error("scene", divergence, world).what();
  };
  EXPECT_NE(said_of_two("ball", "left").find("; near it are right and the ground"),
            std::string::npos)
      << said_of_two("ball", "left");
  EXPECT_EQ(said_of_two("right", "ball").find("near"), std::string::npos)
      << said_of_two("right", "ball");
  for (const char* const name : {"third", "fourth"}) {
    world.rigid.push_back(world.rigid.front());
    world.rigid.back().name = name;
  }
  EXPECT_NE(said("ball").find("; near it are right, left, third and 2 others"), std::string::npos)
      << said("ball");
}

/// A flat ball between two boxes, of which the left one comes nearer.
sim::World pressed_ball(double speed) {
  sim::World world;
  world.settings.ground.reset();
  world.soft.push_back(sim::make_body(sim::make_sphere(3.0, 8, 8), {0.0, 0.0, 0.0}));
  world.soft[0].name = "ball";
  for (int v = 0; v < world.soft[0].positions.size(); ++v) world.soft[0].positions[v][0] *= 0.2;
  for (const double x : {-1.12, 1.12}) {
    world.rigid.push_back(sim::make_rigid({1.0, 9.0, 9.0}, {x, 0.0, 0.0}, 1.0));
    world.rigid.back().name = x < 0.0 ? "left" : "right";
    world.rigid.back().is_kinematic = true;
  }
  world.rigid[0].velocity.x() = speed;
  return world;
}

std::string said_of_pressed_ball(const sim::World& world, bool tried_parts) {
  sim::Divergence divergence{Stage::integrate_soft, 7, "ball", "it broke"};
  divergence.remedy = "magic does";
  return divergence_error("scene", divergence, world, tried_parts).what();
}

TEST(DivergenceError, OfABodyWithoutRoomNamesWhatCrushesItAndNoStep) {
  const std::string crushed = said_of_pressed_ball(pressed_ball(1.0), true);
  EXPECT_NE(crushed.find("ball is crushed between left and right, to "), std::string::npos)
      << crushed;
  EXPECT_EQ(crushed.find("a step of"), std::string::npos) << crushed;
  EXPECT_EQ(crushed.find("magic"), std::string::npos) << crushed;
  EXPECT_NE(crushed.find("let what is moved stop earlier"), std::string::npos) << crushed;
  const std::string still = said_of_pressed_ball(pressed_ball(0.0), true);
  EXPECT_EQ(still.find("crushed"), std::string::npos) << still;
  EXPECT_NE(still.find("a step of"), std::string::npos) << still;
}

TEST(DivergenceError, AdvisesNoShorterStepOnceShorterOnesHaveFailed) {
  sim::World world = pressed_ball(0.0);
  world.settings.integrator = sim::Integrator::implicit_euler;
  EXPECT_NE(said_of_pressed_ball(world, false).find("; magic does"), std::string::npos);
  EXPECT_EQ(said_of_pressed_ball(world, true).find("magic"), std::string::npos);
}

/// Thrown at the ground so hard that no whole step holds it.
scenes::Scene thrown_scene(double k) {
  return scenes::parse_scene(
      "duration = 0.1\n[[body]]\nradius = 1\nposition = [0, 0, 2]\nvelocity = [0, 0, -200]\nk = " +
          std::to_string(k) + "\nk_max = 1e9\n",
      "thrown.toml");
}

void advance(const scenes::Scene& scene, OnDivergence on_divergence) {
  Simulation simulation(scene, build_world(scene), 1, on_divergence);
  simulation.advance_frame();
}

TEST(OnDivergence, DividesStepsThatAreShortEnoughForSmallMotions) {
  const scenes::Scene soft = thrown_scene(50.0), stiff = thrown_scene(1e6);
  EXPECT_NO_THROW(advance(soft, OnDivergence::automatic));
  EXPECT_NO_THROW(advance(soft, OnDivergence::substep));
  EXPECT_THROW(advance(soft, OnDivergence::stop), DivergenceError);
  EXPECT_THROW(advance(stiff, OnDivergence::automatic), DivergenceError);
}

TEST(OnDivergence, OfARunWithoutPicturesIsThatOfOneWithThem) {
  const RunStatistics run = run_statistics(thrown_scene(50.0), 1);
  EXPECT_FALSE(run.divergence) << *run.divergence;
  EXPECT_GT(run.divided_steps, 0);
  EXPECT_GE(run.most_parts, 2);
  Simulation with_pictures(thrown_scene(50.0), build_world(thrown_scene(50.0)), 1);
  for (int frame = 0; frame < scenes::frame_count(thrown_scene(50.0)); ++frame) {
    with_pictures.advance_frame();
  }
  EXPECT_EQ(run.state_hash, sim::state_hash(with_pictures.world()));
  EXPECT_TRUE(run_statistics(thrown_scene(50.0), 1, OnDivergence::stop).divergence);
  EXPECT_TRUE(run_statistics(thrown_scene(1e6), 1).divergence);
}

}  // namespace
}  // namespace pneuma::app
