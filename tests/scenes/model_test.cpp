// Bodies whose shape is a model. No file is read here: scenes only say its name.
#include <gtest/gtest.h>

#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "tests/scenes/refusal.h"
#include "tests/scenes/same_scene.h"

namespace pneuma::scenes {
namespace {

using Strings = std::vector<std::string>;

const std::string one_model =
    "[[body]]\nshape = \"model\"\nmodel.file = \"cat.ply\"\nname = \"tom\"\n";
const std::string with_others = one_model + "[[body]]\n[[body]]\nkind = \"rigid\"\n";

Scene parse_model(const std::string& text, const Strings& overrides = {}) {
  return parse_scene(text, "folder/x.toml", overrides);
}

TEST(Model, IsReadWithDottedKeysOrATable) {
  const std::string keys =
      "file = \"a/cat.obj\"\ncomponent = \"fur\"\nscale = 0.01\nrotation = [90, 0, 5]\ncentre = "
      "false\n";
  std::string dotted = "[[body]]\nshape = \"model\"\n";
  for (std::size_t start = 0; start < keys.size(); start = keys.find('\n', start) + 1) {
    dotted += "model." + keys.substr(start, keys.find('\n', start) + 1 - start);
  }
  for (const std::string& text : {dotted, "[[body]]\nshape = \"model\"\n[body.model]\n" + keys}) {
    const Scene scene = parse_model(text);
    EXPECT_EQ(scene.folder, "folder");
    const ModelScene& model = scene.bodies.at(0).model;
    EXPECT_EQ(model.file, "a/cat.obj");
    EXPECT_EQ(model.component, "fur");
    EXPECT_EQ(model.scale, 0.01);
    EXPECT_EQ(model.rotation, Vec3(90.0, 0.0, 5.0));
    EXPECT_FALSE(model.centre);
    EXPECT_EQ(difference(parse_model(print_scene(scene)), scene), "");
  }
}

TEST(Model, ComponentIsANameOrANumber) {
  EXPECT_EQ(parse_model(one_model + "model.component = 2\n").bodies[0].model.component, "2");
  EXPECT_EQ(parse_model(one_model, {"model.component=12"}).bodies[0].model.component, "12");
  EXPECT_EQ(parse_model(one_model, {"model.component=left leg"}).bodies[0].model.component,
            "left leg");
  expect_in(refusal(one_model + "model.component = 1.5\n"),
            {"x.toml:5:", "a string in quotes or a whole number, got number 1.5"});
}

TEST(Model, IsOverriddenInEveryWay) {
  for (const char* path :
       {"model.file", "body.model.file", "body.1.model.file", "tom.model.file"}) {
    const Scene scene = parse_model(with_others, {std::string(path) + "=/home/me/my cat.stl"});
    EXPECT_EQ(scene.bodies[0].model.file, "/home/me/my cat.stl") << path;
  }
  EXPECT_EQ(
      parse_model("[[body]]\n", {"body.shape=model", "model.file=1.obj"}).bodies[0].model.file,
      "1.obj");
  EXPECT_EQ(parse_model(one_model, {"model.rotation=[0, 0, 9]"}).bodies[0].rotation, Vec3::Zero());
}

TEST(Model, OverridesAreAsStrictAsOthers) {
  expect_in(refusal(with_others, {"model.fil=x"}), {"unknown key 'model.fil'", "'model.file'?"});
  expect_in(refusal(with_others, {"model=x"}), {"model is a table; set its keys one by one"});
  expect_in(refusal(with_others, {"body.model=x"}), {"model is a table"});
  expect_in(refusal(with_others, {"tom.model.file.x=x"}), {"expected NAME.KEY=VALUE"});
  expect_in(refusal(with_others, {"body.2.model.file=x"}), {"model.file applies to models only"});
  expect_in(refusal("[[body]]\n", {"model.file=x"}), {"this scene has none"});
  expect_in(refusal(one_model, {"model.scale=0"}), {"model.scale = 0 m is out of range"});
  expect_in(refusal(one_model, {"model.file=k\xc3\xa4tze.ply"}), {"printable ASCII"});
}

TEST(Model, MistakesInTheFileHaveTheirPlace) {
  expect_in(refusal("[[body]]\nshape = \"model\"\n"), {"x.toml:1:1", "model.file = \"...\""});
  expect_in(refusal("[[body]]\nmodel = \"cat.ply\"\n"),
            {"x.toml:2:1",
             "model must be a table; write model.file = VALUE beside shape = "
             "\"model\"; its keys: model.file, model.component,"});
  expect_in(refusal("[[body]]\nleak = 0.1\n"), {"write leak.area = VALUE; its keys: leak.area, "});
  expect_in(refusal("[[body]]\nmodel.file = \"cat.ply\"\n"),
            {"x.toml:2:7",
             "model.file applies to models only; this is a soft sphere; write shape = \"model\""});
  const std::string rigid = refusal("[[body]]\nkind = \"rigid\"\nmodel.file = \"cat.ply\"\n");
  EXPECT_EQ(rigid.find("write shape"), rigid.npos) << rigid;
  expect_in(refusal(one_model + "radius = 2\n"), {"x.toml:5:1", "this is a soft model"});
  expect_in(refusal(one_model + "model.colour = 2\n"), {"x.toml:5:", "'model.colour'"});
  expect_in(refusal(one_model + "model.file.name = 2\n"), {"x.toml:5:"});
  expect_in(refusal("[[body]]\nkind = \"rigid\"\nshape = \"model\"\nmodel.file = \"a.ply\"\n"),
            {"a rigid body is always a box"});
  expect_in(refusal("[[body]]\nname = \"model\"\n"), {"is the name of a table"});
}

TEST(Model, IsPartOfTheFingerprint) {
  const auto fingerprint = [](const Strings& overrides) {
    return scene_fingerprint(parse_model(one_model, overrides));
  };
  EXPECT_EQ(fingerprint({}), fingerprint({}));
  for (const char* change : {"model.file=dog.ply", "model.component=2", "model.scale=2",
                             "model.rotation=[1, 0, 0]", "model.centre=false"}) {
    EXPECT_NE(fingerprint({change}), fingerprint({})) << change;
  }
}

TEST(Model, IsInTheReference) {
  expect_in(scene_reference(), {"model.file", "model.component", "model.scale", "(models only)"});
}

TEST(Model, CountsWhenItIsRead) {
  const Scene scene = parse_model(one_model, {"limits.vertices=1"});
  EXPECT_EQ(vertex_count(scene.bodies[0]), 0);
  // 1000 bytes per vertex of a body without copies, in round numbers.
  EXPECT_NEAR(estimated_memory_gib(1 << 20, 1), 1000.0 / 1024.0, 0.2);
}

}  // namespace
}  // namespace pneuma::scenes
