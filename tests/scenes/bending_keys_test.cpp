// Bending and its damping: the second says nothing without the first.
#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

const std::string both = "bending_damping = 0.001\nbending = 2.5\n";

TEST(BendingKeys, SetTheirMembersAndReadBack) {
  const Scene scene = load_body(both);
  EXPECT_EQ(scene.bodies[0].material.bending, 2.5);
  EXPECT_EQ(scene.bodies[0].material.bending_damping, 0.001);
  EXPECT_EQ(load_body("bending = 2.5\n").bodies[0].material.bending_damping, 0.0);
  Scene again = parse_scene(print_scene(scene), "x.toml");
  EXPECT_EQ(difference(again, scene), "");
}

TEST(BendingKeys, DampingNeedsBending) {
  expect_in(refusal_of_body("bending_damping = 0.001\n"),
            {"x.toml:2:1", "soft bodies with bending"});
  expect_in(refusal_of_body("bending = 0\nbending_damping = 0.001\n"),
            {"soft bodies with bending"});
  // An override takes the file's back.
  EXPECT_EQ(load_body(both, {"body.bending=0"}).bodies[0].material.bending, 0.0);
}

TEST(BendingKeys, SayWhatIsAllowed) {
  expect_in(refusal_of_body("bending = -1\n"), {"bending >= 0"});
  expect_in(refusal_of_body("bending = 1\nbending_damping = -1\n"),
            {"x.toml:3", "bending_damping >= 0"});
  expect_in(refusal_of_body("kind = \"rigid\"\nbending = 1\n"), {"soft bodies"});
}

TEST(BendingKeys, ThePapersMethodHasNone) {
  expect_in(refusal_of_body("", {"simulation.method=paper", "body.bending=1"}), {"method"});
  const Scene scene = load_body(both, {"simulation.method=paper"});
  EXPECT_EQ(scene.bodies[0].material.bending, 0.0);
  EXPECT_EQ(scene.bodies[0].material.bending_damping, 0.0);
}

}  // namespace
}  // namespace pneuma::scenes
