// How a moved body moves: velocities, or keys in time.
#include <gtest/gtest.h>

#include <initializer_list>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

Scene load(const std::string& body, const std::vector<std::string>& overrides = {}) {
  return parse_scene("[[body]]\n" + body, "x.toml", overrides);
}

void expect_refused(const std::string& body, std::initializer_list<const char*> parts) {
  try {
    load(body);
    ADD_FAILURE() << "was loaded: " << body;
  } catch (const SceneError& error) {
    const std::string text = error.what();
    for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

const std::string moved = "kind = \"moved\"\n";

TEST(MotionKeys, SetTheirMembersAndReadBack) {
  const Scene scene = load(moved +
                           "motion.path = [[0, 0, 0, 0], [1.5, 0, 0, -3]]\n"
                           "motion.rotation = [[2, 0, 0, 90]]\n"
                           "motion.smooth = false\n");
  const sim::KeyFrames& motion = scene.bodies[0].motion;
  EXPECT_EQ(motion.path, (std::vector<sim::KeyFrame>{{0.0, 0.0, 0.0, 0.0}, {1.5, 0.0, 0.0, -3.0}}));
  EXPECT_EQ(motion.rotation, (std::vector<sim::KeyFrame>{{2.0, 0.0, 0.0, 90.0}}));
  EXPECT_FALSE(motion.smooth);
  EXPECT_EQ(difference(parse_scene(print_scene(scene), "x.toml"), scene), "");
  EXPECT_EQ(load(moved, {"body.motion.path=[[0, 1, 2, 3]]"}).bodies[0].motion.path.size(), 1u);
}

TEST(MotionKeys, SayWhatIsAllowed) {
  expect_refused(moved + "motion.path = 3\n", {"x.toml:3:15", "an array of rows [time, x, y, z]"});
  expect_refused(moved + "motion.path = []\n", {"x.toml:3:15", "an array of rows"});
  expect_refused(moved + "motion.path = [[0, 1, 2]]\n", {"x.toml:3:16", "a row [time, x, y, z]"});
  expect_refused(moved + "motion.path = [[0, 1, 2, 1e9]]\n", {"motion.path z", "out of range"});
  expect_refused(moved + "motion.path = [[-1, 1, 2, 3]]\n", {"x.toml:3:17", "before the start"});
  expect_refused(moved + "motion.path = [[1, 0, 0, 0], [1, 0, 0, 1]]\n",
                 {"x.toml:3:30", "times must rise"});
  expect_refused(moved + "motion.smooth = 1\n", {"true or false"});
}

TEST(MotionKeys, TakeThePlaceOfVelocities) {
  expect_refused(moved + "motion.path = [[0, 0, 0, 0]]\nvelocity = [1, 0, 0]\n",
                 {"x.toml:4:1", "have no motion"});
  for (const char* kind : {"static", "rigid", "soft"}) {
    expect_refused("kind = \"" + std::string(kind) + "\"\nmotion.path = [[0, 0, 0, 0]]\n",
                   {"x.toml:3:8", "moved bodies, and soft bodies with pinned, only"});
  }
}

}  // namespace
}  // namespace pneuma::scenes
