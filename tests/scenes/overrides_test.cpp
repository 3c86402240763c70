#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"

namespace pneuma::scenes {
namespace {

const std::string three_bodies = R"(
[[body]]
name = "left"
k = 10
[[body]]
shape = "torus"
[[body]]
name = "cube"
kind = "rigid"
)";

Scene overridden(const std::vector<std::string>& overrides,
                 const std::string& text = three_bodies) {
  return parse_scene(text, "x.toml", overrides);
}

std::string refusal_of(const std::vector<std::string>& overrides,
                       const std::string& text = three_bodies) {
  try {
    parse_scene(text, "x.toml", overrides);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

void expect_refusal(const std::string& override_text, const std::vector<std::string>& words) {
  const std::string message = refusal_of({override_text});
  EXPECT_EQ(message.rfind("--set " + override_text + ": ", 0), 0u) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
}

TEST(Overrides, SetKeysOfTables) {
  const Scene scene =
      overridden({"duration=2", "simulation.integrator=martin", "simulation.gravity=[0,0,-1.62]",
                  "simulation.contact=impulses", "simulation.particles.max_sweeps=3",
                  "picture.width=640", "ground.present=false", "title=Three bodies on the moon",
                  "figure='6.5'", "limits.frames=60"});
  EXPECT_EQ(scene.duration, 2.0);
  EXPECT_EQ(scene.settings.integrator, sim::Integrator::martin);
  EXPECT_EQ(scene.settings.gravity, Vec3(0.0, 0.0, -1.62));
  EXPECT_EQ(scene.settings.particles.max_sweeps, 3);
  EXPECT_EQ(scene.picture.width, 640);
  EXPECT_FALSE(scene.settings.ground);
  EXPECT_EQ(scene.title, "Three bodies on the moon");
  EXPECT_EQ(scene.figure, "6.5");
  EXPECT_EQ(scene.limits.frames, 60);
}

TEST(Overrides, OfEveryBodyReachThoseToWhichTheKeyApplies) {
  const Scene scene = overridden({"body.k=200", "body.stacks=5", "body.mass=4"});
  EXPECT_EQ(scene.bodies[0].material.k, 200.0);
  EXPECT_EQ(scene.bodies[1].material.k, 200.0);
  EXPECT_EQ(scene.bodies[2].material.k, sim::SoftMaterial{}.k);
  EXPECT_EQ(scene.bodies[0].stacks, 5);
  EXPECT_EQ(scene.bodies[1].stacks, 5);
  EXPECT_EQ(scene.bodies[2].mass, 4.0);
}

TEST(Overrides, OfOneBodyByNumberOrName) {
  const Scene scene =
      overridden({"body.2.k=7", "left.n=3", "cube.mass=9", "body2.slices=11", "body.3.name=dice"});
  EXPECT_EQ(scene.bodies[0].material.k, 10.0);
  EXPECT_EQ(scene.bodies[1].material.k, 7.0);
  EXPECT_EQ(scene.bodies[0].material.n, 3.0);
  EXPECT_EQ(scene.bodies[1].slices, 11);
  EXPECT_EQ(scene.bodies[2].mass, 9.0);
  EXPECT_EQ(scene.bodies[2].name, "dice");
}

TEST(Overrides, TheLastOneWins) {
  EXPECT_EQ(overridden({"left.k=1", "body.k=2"}).bodies[0].material.k, 2.0);
  EXPECT_EQ(overridden({"body.k=2", "left.k=1"}).bodies[0].material.k, 1.0);
}

TEST(Overrides, TakeTheFilesPlaceBeforeAnythingIsChecked) {
  const std::string bad = "duration = \"long\"\n[picture]\nframes_per_second = 25\n[[body]]\n";
  EXPECT_NE(refusal_of({}, bad), "");
  EXPECT_EQ(refusal_of({"duration=2", "simulation.steps_per_second=100"}, bad), "");
}

TEST(Overrides, OfASelectorSilenceTheFilesKeysThatNoLongerApply) {
  const std::string text = "[ground]\nfriction = 0.25\n[[body]]\nk = 10\n";
  const Scene scene = overridden({"ground.present=false", "body.kind=rigid"}, text);
  EXPECT_FALSE(scene.settings.ground);
  EXPECT_EQ(scene.bodies[0].kind, BodyKind::rigid);
  EXPECT_EQ(scene.bodies[0].shape, Shape::box);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(
      scene.warnings[0].find(":4:1: warning: no effect of k: --set has made this a rigid box"),
      std::string::npos)
      << scene.warnings[0];
  // What an override takes the place of is not worth a word.
  EXPECT_TRUE(overridden({"body.inflation=2"}, "[[body]]\nn = 1\n").warnings.empty());
  // An override of such a key is still an error.
  const std::string message = refusal_of({"body.kind=rigid", "body.1.k=5"}, text);
  EXPECT_NE(message.find("k applies to soft bodies only"), std::string::npos) << message;
}

TEST(Overrides, AreAsStrictAsTheFile) {
  expect_refusal("body.k=abc", {"k: expected a number, got string \"abc\""});
  expect_refusal("body.k=-1", {"allowed: k >= 0 N/m"});
  expect_refusal("body.k=nan", {"not finite"});
  expect_refusal("body.raduis=1", {"unknown key 'raduis'", "did you mean 'radius'?"});
  expect_refusal("cube.k=1", {"k applies to soft bodies only", "a rigid box"});
  expect_refusal("body.subdivisions=1", {"icospheres only", "this scene has none"});
  expect_refusal("simulation.integrator=rk5", {"did you mean 'rk4'?"});
  expect_refusal("duratoin=1", {"did you mean 'duration'?"});
  expect_refusal("gravity=[0,0,0]", {"belongs in [simulation]"});
  expect_refusal("simulation.steps_per_second=50", {"does not divide"});
  expect_refusal("title=5", {"expected a string in quotes, got integer 5"});
  expect_refusal("simulation.gravity=5", {"expected an array of 3 numbers"});
  expect_refusal("body.k=", {"expected a number, got string \"\""});
}

TEST(Overrides, OldNamesOfKeysAreRefusedWithTheNewOnes) {
  expect_refusal("body.pressure=uniform", {": body.pressure is now body.pressure_weighting"});
  expect_refusal("left.pressure=uniform", {": body.pressure is now body.pressure_weighting"});
  expect_refusal("simulation.separation_time=0",
                 {": simulation.separation_time is now simulation.relaxation_time"});
  expect_refusal("simulation.impulse_sweeps=5",
                 {": simulation.impulse_sweeps is now simulation.contact_iterations"});
}

TEST(Overrides, PathsThatLeadNowhere) {
  expect_refusal("duration", {"expected PATH=VALUE"});
  expect_refusal("=1", {"PATH"});
  expect_refusal("camera..eye=1", {"PATH"});
  expect_refusal("simulaton.seed=1",
                 {"no table or body 'simulaton'", "did you mean 'simulation'?"});
  expect_refusal("letf.k=1", {"no table or body 'letf'", "did you mean 'left'?"});
  expect_refusal("body.4.k=1", {"no body number '4'", "the scene has 3"});
  expect_refusal("body.0.k=1", {"counted from 1"});
  expect_refusal("body.2x.k=1", {"no body number '2x'"});
  expect_refusal("body.99999999999999999999.k=1", {"no body number"});
  expect_refusal("body.1.material.k=1", {"body.NUMBER.KEY=VALUE"});
  expect_refusal("left.material.k=1", {"NAME.KEY=VALUE"});
  expect_refusal("body=1", {"body.KEY=VALUE"});
  expect_refusal("camera=1", {"camera is a table"});
  expect_refusal("simulation.particles=1", {"simulation.particles is a table"});
  expect_refusal("simulation.seed.x=1", {"'simulation.seed' is no table"});
  expect_refusal("simulation.partcles.max_sweeps=1",
                 {"no table", "did you mean 'simulation.particles'?"});
  expect_refusal("simulation.\x1b[2J.x=1", {"'simulation.\\x1b[2J' is no table"});
}

TEST(Overrides, OfOneCopyAreRefusedWithWhatCanBeSet) {
  const std::string copies = "[[body]]\nname = \"ball\"\ncopies = [2, 1, 1]\nspacing = [9, 0, 0]\n";
  const std::string message = refusal_of({"ball.2.k=200"}, copies);
  for (const char* part : {"--set ball.2.k=200: the copies of ball", "one by one", "ball.k sets",
                           "a [[body]] of its own"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_NE(refusal_of({"ball.2.model.file=x"}, copies).find("ball.model.file sets"),
            std::string::npos);
  EXPECT_EQ(overridden({"ball.k=200"}, copies).bodies[0].material.k, 200.0);
  EXPECT_NE(refusal_of({"ball.two.k=200"}, copies).find("NAME.KEY=VALUE"), std::string::npos);
}

TEST(Overrides, ValuesThatAreNone) {
  expect_refusal("simulation.gravity=[0,0", {"cannot be read"});
  expect_refusal("title=\"open", {"cannot be read"});
  EXPECT_NE(refusal_of({"duration=2\ntitle=\"x\""}).find("line break"), std::string::npos);
}

TEST(Overrides, FollowTheFilesErrors) {
  const std::string message = refusal_of({"duration=x"}, "titel = 1\n[[body]]\n");
  const std::size_t file = message.find("x.toml:1:1: unknown key 'titel'");
  const std::size_t set = message.find("--set duration=x: duration: expected a number");
  ASSERT_NE(file, std::string::npos) << message;
  ASSERT_NE(set, std::string::npos) << message;
  EXPECT_LT(file, set);
}

}  // namespace
}  // namespace pneuma::scenes
