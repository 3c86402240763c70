// The keys that hold vertices of soft bodies, and obstacles of any shape.
#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

TEST(PinnedKeys, SetTheirMembersAndReadBack) {
  const Scene scene = load_body(
      "pinned = [[-1, -2, -3, 1, 2, 3], [4, 4, 4, 5, 5, 5]]\n"
      "motion.path = [[0, 0, 0, 0], [1.5, 0, 0, -3]]\n"
      "motion.still = [[4, 4, 4, 5, 5, 5]]\n");
  const BodyScene& body = scene.bodies[0];
  EXPECT_EQ(body.pinned, (std::vector<Region>{{-1, -2, -3, 1, 2, 3}, {4, 4, 4, 5, 5, 5}}));
  EXPECT_EQ(body.still, (std::vector<Region>{{4, 4, 4, 5, 5, 5}}));
  EXPECT_EQ(difference(parse_scene(print_scene(scene), "x.toml"), scene), "");
  EXPECT_EQ(load_body("", {"body.pinned=[[0, 0, 0, 1, 1, 1]]"}).bodies[0].pinned.size(), 1u);
}

TEST(PinnedKeys, SayWhatIsAllowed) {
  expect_in(refusal_of_body("pinned = 3\n"),
            {"x.toml:2:10", "rows [xmin, ymin, zmin, xmax, ymax, zmax]"});
  expect_in(refusal_of_body("pinned = [[0, 0, 1]]\n"), {"x.toml:2:11", "a row [xmin, ymin, zmin"});
  expect_in(refusal_of_body("pinned = [[0, 0, 0, 1, -1, 1]]\n"),
            {"x.toml:2:24", "pinned y from 0 m to -1 m"});
  expect_in(refusal_of_body("pinned = [[0, 0, 0, 1, 1, 1e9]]\n"), {"pinned z", "out of range"});
  expect_in(refusal_of_body("kind = \"rigid\"\npinned = [[0, 0, 0, 1, 1, 1]]\n"),
            {"x.toml:3:1", "soft bodies only"});
  expect_in(refusal_of_body("motion.still = [[0, 0, 0, 1, 1, 1]]\n"),
            {"x.toml:2:8", "soft bodies with pinned and a motion only"});
}

TEST(PinnedKeys, NeedSweptContacts) {
  expect_in(
      refusal_of_body("pinned = [[0, 0, 0, 1, 1, 1]]\n[simulation]\ncontact = \"impulses\"\n"),
      {"x.toml:2:10", "pinned vertices need swept contacts or the contact potential"});
  expect_in(refusal_of_body("pinned = [[0, 0, 0, 1, 1, 1]]\n[simulation]\nmethod = \"paper\"\n"),
            {"pinned vertices need swept contacts or the contact potential"});
}

TEST(PinnedKeys, AreNotAdvisedAPotentialBesideSprings) {
  const std::string said = refusal_of_body(
      "pinned = [[0, 0, 0, 1, 1, 1]]\n[[body]]\n[[spring]]\nfrom = \"body1\"\nto = \"body2\"\n"
      "k = 1\n[simulation]\ncontact = \"impulses\"\n");
  expect_in(said, {"pinned vertices need swept contacts; set simulation.contact = \"swept\" and"});
}

TEST(Obstacles, AreBoxesUnlessToldOtherwise) {
  for (const char* kind : {"static", "moved"}) {
    const std::string line = "kind = \"" + std::string(kind) + "\"\n";
    EXPECT_EQ(load_body(line).bodies[0].shape, Shape::box);
    EXPECT_TRUE(is_box(load_body(line).bodies[0]));
    const Scene scene = load_body(line + "shape = \"torus\"\nradius = 2.0\n");
    EXPECT_EQ(scene.bodies[0].shape, Shape::torus);
    EXPECT_FALSE(is_box(scene.bodies[0]));
    EXPECT_EQ(difference(parse_scene(print_scene(scene), "x.toml"), scene), "");
    expect_in(refusal_of_body(line + "shape = \"sphere\"\nn = 1.0\n"),
              {"x.toml:4:1", "n applies to"});
    expect_in(refusal_of_body(line + "shape = \"sphere\"\nsize = [1, 1, 1]\n"),
              {"x.toml:4:1", "boxes only"});
    expect_in(refusal_of_body(line + "shape = \"model\"\n"), {"a model needs a file"});
  }
  expect_in(refusal_of_body("kind = \"rigid\"\nshape = \"sphere\"\n"),
            {"a rigid body is always a box"});
}

}  // namespace
}  // namespace pneuma::scenes
