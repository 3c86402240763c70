// What a run says of bodies that are pressed to next to nothing, or not in the picture.
#include "app/render/run_notices.h"

#include <gtest/gtest.h>

#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "sim/mesh/primitives.h"
#include "sim/soft/pins.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

/// What is said in the end of a ball of 1 mol whose height is `share` of what it was.
std::string said_of(double share, bool leaks = false) {
  sim::World world;
  world.soft.push_back(sim::make_body(sim::make_icosphere(1.0, 2)));
  world.soft[0].name = "ball";
  world.soft[0].material.n = 1.0;
  if (leaks) {
    auto supply = std::make_shared<sim::GasSupply>();
    supply->leak.area = 0.1;
    world.soft[0].supply = supply;
  }
  PressedBodies pressed;
  pressed.add(world);
  for (int v = 0; v < world.soft[0].positions.size(); ++v) world.soft[0].positions[v][2] *= share;
  pressed.add(world);
  Progress progress(Progress::Style::lines);
  testing::internal::CaptureStderr();
  pressed.summarise(progress);
  return testing::internal::GetCapturedStderr();
}

/// Of one frame in which body1 of the scene crosses itself.
std::string said_of_crossing(const std::string& text, bool is_resumed) {
  const scenes::Scene scene = scenes::parse_scene(text, "crossed.toml");
  const Simulation simulation(scene, build_world(scene), 1);
  FrameState state;
  state.crosses_itself = "body1";
  CrossedFrames crossed;
  Progress progress(Progress::Style::lines);
  crossed.add(simulation, state, progress);
  testing::internal::CaptureStderr();
  crossed.summarise(progress, is_resumed);
  return testing::internal::GetCapturedStderr();
}

TEST(CrossedFrames, OfAResumedRunAreThoseDrawnNow) {
  for (const bool is_resumed : {false, true}) {
    const std::string said = said_of_crossing("[[body]]\n", is_resumed);
    const char* of = is_resumed ? "in 1 of the 1 frame drawn now;" : "in 1 of 1 frame;";
    EXPECT_NE(said.find(of), std::string::npos) << said;
  }
}

TEST(CrossedFrames, AreNotToBeRuledOutByWhatTheSceneCannotHave) {
  const std::string two = "[[body]]\nposition = [0, 0, 4]\n[[body]]\nposition = [9, 0, 4]\n";
  const std::string tied = two + "[[spring]]\nfrom = \"body1\"\nto = \"body2\"\nk = 1\n";
  EXPECT_NE(said_of_crossing(two, false).find("potential"), std::string::npos);
  const std::string said = said_of_crossing(tied, false);
  EXPECT_NE(said.find("passes through itself"), std::string::npos) << said;
  EXPECT_EQ(said.find("potential"), std::string::npos) << said;
}

TEST(PressedBodies, AreNamedWithTheShareThatIsLeft) {
  const std::string said = said_of(0.05);
  EXPECT_NE(said.find("body 'ball' was pressed to 5 % of its shape's volume"), std::string::npos)
      << said;
  EXPECT_EQ(said_of(0.2), "");
  EXPECT_EQ(said_of(0.05, true), "");
}

/// Of three frames of a ball at the origin, the last of them where it has gone by `way`.
std::string said_of_unseen(const sim::Vec3& eye, const sim::Vec3& way, bool is_pinned = false) {
  sim::World world;
  world.soft.push_back(sim::make_body(sim::make_icosphere(1.0, 2)));
  world.soft[0].name = "ball";
  if (is_pinned) {
    const std::vector<std::uint8_t> all(sim::at(world.soft[0].positions.size()), 1);
    world.soft[0].pins = sim::make_pins(world.soft[0].positions, all, all, {});
  }
  const render::Camera camera{.eye = eye.cast<float>(),
                              .target = (eye + sim::Vec3::UnitY()).cast<float>()};
  UnseenFrames unseen;
  unseen.add(world, camera, 1.5);
  unseen.add(world, camera, 1.5);
  for (int v = 0; v < world.soft[0].positions.size(); ++v) world.soft[0].positions[v] += way;
  unseen.add(world, camera, 1.5);
  Progress progress(Progress::Style::lines);
  testing::internal::CaptureStderr();
  unseen.summarise(progress);
  return testing::internal::GetCapturedStderr();
}

TEST(UnseenFrames, AreThoseWithNoMovableBodyInThePicture) {
  const sim::Vec3 before(0.0, -10.0, 0.0), still = sim::Vec3::Zero();
  EXPECT_EQ(said_of_unseen(before, still), "");
  // 40 degrees upright and half as much again across: 3.6 m up and 5.5 m aside at 10 m.
  EXPECT_EQ(said_of_unseen(before, {0.0, 0.0, 4.4}), "");
  EXPECT_EQ(said_of_unseen(before, {6.3, 0.0, 0.0}), "");
  for (const sim::Vec3& way : {sim::Vec3(0.0, 0.0, 4.8), sim::Vec3(6.7, 0.0, 0.0)}) {
    const std::string said = said_of_unseen(before, way);
    EXPECT_NE(said.find("no body that may move is in the picture in 1 of 3 frames"),
              std::string::npos)
        << said << way.transpose();
  }
  EXPECT_NE(said_of_unseen({0.0, 10.0, 0.0}, still).find("in 3 of 3 frames"), std::string::npos);
  EXPECT_EQ(said_of_unseen({0.0, 10.0, 0.0}, still, true), "");  // of what none may move
}

/// Of a box that fills the picture no corner and no middle is in it.
TEST(UnseenFrames, AreNoneWhereABoxReachesIntoThePicture) {
  sim::World world;
  world.rigid = {sim::make_rigid({40.0, 1.0, 40.0}, {15.0, 0.0, 0.0})};
  UnseenFrames unseen;
  unseen.add(world, {.eye = {0.0f, -10.0f, 0.0f}, .target = {0.0f, 0.0f, 0.0f}}, 1.5);
  Progress progress(Progress::Style::lines);
  testing::internal::CaptureStderr();
  unseen.summarise(progress);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(UnseenFrames, AreTheInsideOfABodyToo) {
  const std::string said = said_of_unseen({0.0, -0.5, 0.0}, {0.0, 30.0, 0.0});
  EXPECT_NE(said.find("the camera is inside of body 'ball' in 2 of 3 frames"), std::string::npos)
      << said;
}

}  // namespace
}  // namespace pneuma::app
