// How a moved body moves: velocities, or keys in time.
#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

const std::string moved = "kind = \"moved\"\n";

TEST(MotionKeys, SetTheirMembersAndReadBack) {
  const Scene scene = load_body(moved +
                                "motion.path = [[0, 0, 0, 0], [1.5, 0, 0, -3]]\n"
                                "motion.rotation = [[2, 0, 0, 90]]\n"
                                "motion.smooth = false\n");
  const sim::KeyFrames& motion = scene.bodies[0].motion;
  EXPECT_EQ(motion.path, (std::vector<sim::KeyFrame>{{0.0, 0.0, 0.0, 0.0}, {1.5, 0.0, 0.0, -3.0}}));
  EXPECT_EQ(motion.rotation, (std::vector<sim::KeyFrame>{{2.0, 0.0, 0.0, 90.0}}));
  EXPECT_FALSE(motion.smooth);
  EXPECT_EQ(difference(parse_scene(print_scene(scene), "x.toml"), scene), "");
  EXPECT_EQ(load_body(moved, {"body.motion.path=[[0, 1, 2, 3]]"}).bodies[0].motion.path.size(), 1u);
}

TEST(MotionKeys, SayWhatIsAllowed) {
  expect_in(refusal_of_body(moved + "motion.path = 3\n"),
            {"x.toml:3:15", "an array of rows [time, x, y, z]"});
  expect_in(refusal_of_body(moved + "motion.path = []\n"), {"x.toml:3:15", "an array of rows"});
  expect_in(refusal_of_body(moved + "motion.path = [[0, 1, 2]]\n"),
            {"x.toml:3:16", "a row [time, x, y, z]"});
  expect_in(refusal_of_body(moved + "motion.path = [[0, 1, 2, 1e9]]\n"),
            {"motion.path z = 1000000000 m is out of range"});
  expect_in(refusal_of_body(moved + "motion.rotation = [[0, 1, 1e9, 2]]\n"),
            {"motion.rotation y = 1000000000 degrees is out of range"});
  expect_in(refusal_of_body(moved + "motion.path = [[-1, 1, 2, 3]]\n"),
            {"x.toml:3:17", "before the start"});
  expect_in(refusal_of_body(moved + "motion.path = [[1, 0, 0, 0], [1, 0, 0, 1]]\n"),
            {"x.toml:3:30", "times must rise"});
  expect_in(refusal_of_body(moved + "motion.smooth = 1\n"), {"true or false"});
}

TEST(MotionKeys, TakeThePlaceOfVelocities) {
  expect_in(refusal_of_body(moved + "motion.path = [[0, 0, 0, 0]]\nvelocity = [1, 0, 0]\n"),
            {"x.toml:4:1", "have no motion"});
  for (const char* kind : {"static", "rigid", "soft"}) {
    expect_in(
        refusal_of_body("kind = \"" + std::string(kind) + "\"\nmotion.path = [[0, 0, 0, 0]]\n"),
        {"x.toml:3:8", "moved bodies, and soft bodies with pinned, only"});
  }
}

}  // namespace
}  // namespace pneuma::scenes
