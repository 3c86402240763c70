// Keys of cameras that move: a path, a body to follow, an orbit.
#include <gtest/gtest.h>

#include <initializer_list>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

Scene load_camera(const std::string& camera, const std::vector<std::string>& overrides = {}) {
  return parse_scene("[camera]\n" + camera + "\n[[body]]\nname = \"ball\"\n", "x.toml", overrides);
}

void expect_camera_refused(const std::string& camera, std::initializer_list<const char*> parts) {
  try {
    load_camera(camera);
    ADD_FAILURE() << "was loaded: " << camera;
  } catch (const SceneError& error) {
    const std::string text = error.what();
    for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

const std::string path = "path = [[0, 0, -9, 3, 0, 0, 1], [1.5, 9, 0, 3, 0, 0, 1]]";

TEST(CameraKeys, SetTheirMembersAndReadBack) {
  for (const std::string& camera :
       {path, std::string("follow = \"ball\"\norbit = -30.5"),
        std::string("eye = [0, -9, 3]\ntarget = [0, 0, 1]\norbit = 10\nfollow = \"ball\"")}) {
    const Scene scene = load_camera(camera);
    EXPECT_EQ(difference(parse_scene(print_scene(scene), scene.name + ".toml"), scene), "");
  }
  EXPECT_EQ(load_camera(path).camera.path[1], (CameraKey{1.5, 9, 0, 3, 0, 0, 1}));
  EXPECT_EQ(load_camera("follow = \"ball\"").camera.follow, "ball");
  EXPECT_EQ(load_camera("", {"camera.orbit=45"}).camera.orbit, 45.0);
  EXPECT_EQ(load_camera("", {"camera.path=[[0, 1, 2, 3, 4, 5, 6]]"}).camera.path.size(), 1u);
}

TEST(CameraKeys, AreRefusedWithWhatIsAllowed) {
  expect_camera_refused("path = 3",
                        {"x.toml:2:8", "an array of rows [time, eye x, y, z, target x, y, z]"});
  expect_camera_refused("path = []", {"x.toml:2:8", "an array of rows"});
  expect_camera_refused("path = [[0, 1, 2, 3]]", {"x.toml:2:9", "a row [time, eye"});
  expect_camera_refused("path = [[-1, 0, 0, 0, 1, 1, 1]]", {"x.toml:2:10", "before the start"});
  expect_camera_refused("path = [[0, 0, 0, 0, 1, 1, 1e9]]",
                        {"path z = 1000000000 m is out of range"});
  expect_camera_refused("path = [[0, 1, 2, 3, 1, 2, 3]]", {"x.toml:2:9", "the same point"});
  expect_camera_refused("path = [[1, 0, 0, 0, 1, 1, 1], [1, 0, 0, 0, 1, 1, 2]]",
                        {"x.toml:2:32", "times must rise"});
  expect_camera_refused("follow = \"bal\"",
                        {"x.toml:2:10", "no body 'bal'", "did you mean 'ball'?"});
  expect_camera_refused("orbit = 1e9", {"orbit", "out of range"});
}

TEST(CameraKeys, OfAPathStandAlone) {
  for (const char* other : {"eye = [1, 2, 3]", "target = [1, 2, 3]", "orbit = 10",
                            "follow = \"ball\"", "azimuth = 20", "elevation = 20"}) {
    expect_camera_refused(path + "\n" + other,
                          {"applies to a camera without", "a camera with a path"});
  }
  EXPECT_NO_THROW(load_camera(path + "\nfield_of_view = 50"));
}

}  // namespace
}  // namespace pneuma::scenes
