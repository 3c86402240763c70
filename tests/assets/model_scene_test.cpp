// Models in scenes: where they are found, limits, runs that are continued.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/files/find_model.h"
#include "app/files/find_scene.h"
#include "app/world/build_world.h"
#include "assets/model.h"
#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/primitives.h"
#include "tests/assets/model_writers.h"
#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

using Strings = std::vector<std::string>;

const std::string scene_text =
    "duration = 0.5\n[picture]\nwidth = 64\nheight = 48\nsamples = 1\n"
    "[[body]]\nshape = \"model\"\nmodel.file = \"it.ply\"\nposition = [0.0, 0.0, 5.0]\n";

class ModelScene : public testing::Test {
 protected:
  ModelScene() {
    write_text(folder_ / "it.ply", assets::ply_text(assets::cube()));
    write_text(folder_ / "it.toml", scene_text);
  }

  scenes::Scene load(const Strings& overrides = {}) const {
    return scenes::load_scene(folder_ / "it.toml", overrides);
  }

  TemporaryFolder folder_;
};

TEST_F(ModelScene, IsASoftBodyOfTheModelsMesh) {
  const sim::World world = build_world(load({"model.scale=2", "body.copies=[2, 1, 1]"}));
  ASSERT_EQ(world.soft.size(), 2u);
  const sim::SoftBody& body = world.soft[0];
  EXPECT_EQ(body.mesh->topology.vertex_count(), 8);
  EXPECT_EQ(body.mesh, world.soft[1].mesh);
  EXPECT_DOUBLE_EQ(sim::volume(body.mesh->topology, body.positions), 64.0);
  EXPECT_EQ(sim::bounds(body.positions).centre(), sim::Vec3(0.0, 0.0, 5.0));
}

TEST_F(ModelScene, BodiesOfDifferentModelsDoNotShareAMesh) {
  write_text(folder_ / "it.toml", scene_text +
                                      "[[body]]\nshape = \"model\"\nmodel.file = "
                                      "\"it.ply\"\nposition = [9.0, 0.0, 5.0]\n");
  const auto meshes = [&](const Strings& overrides) {
    const sim::World world = build_world(load(overrides));
    return world.soft.at(0).mesh == world.soft.at(1).mesh ? 1 : 2;
  };
  EXPECT_EQ(meshes({}), 1);
  EXPECT_EQ(meshes({"body.2.model.scale=3"}), 2);
  EXPECT_EQ(meshes({"body.2.model.rotation=[0, 0, 1]"}), 2);
  EXPECT_EQ(meshes({"body.2.model.centre=false"}), 2);
  EXPECT_EQ(meshes({"body.2.model.component=1"}), 2);
}

TEST_F(ModelScene, IsFoundBesideTheSceneAndAmongTheProgramsModels) {
  EXPECT_EQ(find_model("it.ply", folder_.path()), folder_ / "it.ply");
  EXPECT_EQ(find_model("/any/where.ply", folder_.path()), "/any/where.ply");
  EXPECT_EQ(find_model("pear.ply", folder_.path()).filename(), "pear.ply");
  try {
    find_model("gone.ply", folder_.path());
    FAIL() << "found";
  } catch (const assets::ModelError& error) {
    EXPECT_NE(std::string(error.what()).find((folder_ / "gone.ply").string()), std::string::npos);
  }
}

TEST_F(ModelScene, AMissingFileIsBlamedOnTheScenesLine) {
  for (const auto& [typed, meant] : {std::pair{"model.file=it.pyl", "there are: it.ply"},
                                     std::pair{"model.file=ti.ply", "did you mean 'it.ply'?"}}) {
    try {
      build_world(load({typed}));
      FAIL() << "built";
    } catch (const scenes::SceneError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(fmt::format("--set {}: body '", typed)), std::string::npos) << message;
      EXPECT_NE(message.find(meant), std::string::npos) << message;
    }
  }
}

TEST_F(ModelScene, AnObjKeepsItsOwnNumbers) {
  // An octahedron, and the same without its last face.
  std::string obj;
  for (const char* vertex : {"1 0 0", "-1 0 0", "0 1 0", "0 -1 0", "0 0 1", "0 0 -1"}) {
    obj += std::string("v ") + vertex + "\n";
  }
  obj += "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\n";
  write_text(folder_ / "open.obj", obj);
  write_text(folder_ / "closed.obj", obj + "f 1 4 6\n");
  const ProgramResult closed = run_pneuma("check " + (folder_ / "closed.obj").string());
  EXPECT_EQ(closed.exit_code, 0);
  EXPECT_NE(closed.output.find("vertices           6\n"), std::string::npos) << closed.output;
  EXPECT_EQ(closed.output.find("cleaned"), std::string::npos) << closed.output;
  EXPECT_EQ(closed.output.find("defaultobject"), std::string::npos) << closed.output;
  const ProgramResult open = run_pneuma("check " + (folder_ / "open.obj").string() + " 2>&1");
  EXPECT_EQ(open.exit_code, 3);
  for (const auto& [edge, turned] :
       {std::pair("edge 1-4 ", "edge 4-1 "), std::pair("edge 1-6 ", "edge 6-1 "),
        std::pair("edge 4-6 ", "edge 6-4 ")}) {
    EXPECT_TRUE(open.output.find(edge) != std::string::npos ||
                open.output.find(turned) != std::string::npos)
        << open.output;
  }
}

TEST_F(ModelScene, KeepsToTheScenesLimits) {
  const auto refused = [&](const Strings& overrides) {
    const scenes::Scene scene = load(overrides);
    try {
      build_world(scene);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refused({"limits.vertices_per_body=8", "limits.vertices=8"}), "accepted");
  EXPECT_NE(refused({"limits.vertices_per_body=7"}).find("more than the limit of 7"),
            std::string::npos);
  EXPECT_NE(refused({"limits.vertices=15", "body.copies=[2, 1, 1]"}).find("limit of 15"),
            std::string::npos);
  EXPECT_NE(refused({"limits.memory_gib=0.001", "body.copies=[400, 1, 1]"}).find("GiB"),
            std::string::npos);
  const double mib = static_cast<double>(std::filesystem::file_size(folder_ / "it.ply")) / 1048576;
  const auto size_limit = [&](double share) {
    return Strings{fmt::format("limits.model_file_mib={}", share * mib)};
  };
  EXPECT_EQ(refused(size_limit(1.01)), "accepted");
  EXPECT_NE(refused(size_limit(0.99)).find("more than the limit of"), std::string::npos);
}

TEST_F(ModelScene, SaysWhichModelItHas) {
  const auto fingerprints = [&](const Strings& overrides = {}) {
    const scenes::Scene scene = load(overrides);
    return model_fingerprints(scene, build_world(scene));
  };
  const auto before = fingerprints();
  ASSERT_EQ(before.size(), 1u);
  EXPECT_EQ(fingerprints(), before);
  EXPECT_EQ(fingerprints({"body.k=9"}), before);
  EXPECT_NE(fingerprints({"model.scale=2"}), before);
  // The same vertices, but another diagonal of a face.
  sim::TriangleMesh other = assets::cube();
  sim::Triangle &a = other.triangles[0], &b = other.triangles[1];  // the halves of one face
  const auto opposite = [](const sim::Triangle& of, const sim::Triangle& to) {
    return *std::find_if(of.begin(), of.end(),
                         [&](int v) { return std::find(to.begin(), to.end(), v) == to.end(); });
  };
  const int p = opposite(a, b), q = opposite(b, a);
  const auto after = [&](int v) {
    const auto place = std::find(a.begin(), a.end(), v) - a.begin();
    return a[static_cast<std::size_t>((place + 1) % 3)];
  };
  const int r = after(p), s = after(r);
  a = {p, r, q};
  b = {q, s, p};
  write_text(folder_ / "it.ply", assets::ply_text(other));
  EXPECT_NE(fingerprints(), before);
}

TEST_F(ModelScene, ARunIsNotContinuedWithAnotherModel) {
  const std::string render =
      "render " + (folder_ / "it.toml").string() + " --quiet --out " + (folder_ / "out").string();
  ASSERT_EQ(run_pneuma(render + " 2>&1").exit_code, 0);
  EXPECT_EQ(run_pneuma(render + " --resume 2>&1").exit_code, 0);
  write_text(folder_ / "it.ply", assets::ply_text(assets::crooked_box()));
  const ProgramResult other = run_pneuma(render + " --resume 2>&1");
  EXPECT_EQ(other.exit_code, 6) << other.output;
  EXPECT_NE(other.output.find("models: was"), std::string::npos) << other.output;
}

TEST_F(ModelScene, HasAtMostAsManyVerticesAsItSays) {
  write_text(folder_ / "it.ply", assets::ply_text(sim::make_icosphere(1.0, 3)));
  for (const char* kind : {"soft", "static", "moved"}) {
    const Strings overrides = {"model.vertices=100", fmt::format("body.kind={}", kind)};
    EXPECT_EQ(build_world(load(overrides)).soft.at(0).mesh->topology.vertex_count(), 100) << kind;
  }
  const scenes::Scene many = load({"model.vertices=900"}), all = load();
  EXPECT_EQ(model_fingerprints(many, build_world(many)), model_fingerprints(all, build_world(all)));
  write_text(folder_ / "it.toml", scene_text + "model.vertices = 3\n");
  try {
    load();
    FAIL() << "loaded";
  } catch (const scenes::SceneError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("it.toml:10:18: model.vertices = 3 is out of range; allowed: 20"),
              std::string::npos)
        << message;
  }
}

TEST_F(ModelScene, TheShippedSceneTakesAnyonesModel) {
  const scenes::Scene scene = scenes::load_scene(
      find_scene("model"), Strings{"model.file=" + (folder_ / "it.ply").string()});
  EXPECT_EQ(build_world(scene).soft.at(0).mesh->topology.vertex_count(), 8);
}

TEST_F(ModelScene, CheckReportsAModelFile) {
  const std::string path = (folder_ / "it.ply").string();
  const ProgramResult text = run_pneuma("check " + path);
  EXPECT_EQ(text.exit_code, 0);
  for (const char* part : {"fit for a soft body", "vertices           8\n", "genus              0",
                           "volume             8 m^3", "12, smallest angle 45 degrees"}) {
    EXPECT_NE(text.output.find(part), std::string::npos) << part << " in: " << text.output;
  }
  const auto json = nlohmann::json::parse(run_pneuma("check --json " + path).output);
  EXPECT_EQ(json["vertices"], 8);
  EXPECT_EQ(json["volume_m3"], 8.0);
  EXPECT_EQ(json["components"].size(), 1u);
}

}  // namespace
}  // namespace pneuma::app
