// The fuzzers' targets on what they start from, and on every input that once broke one.
#include <gtest/gtest.h>

#include <filesystem>

#include "assets/clean_mesh.h"
#include "assets/weld.h"
#include "sim/mesh/primitives.h"
#include "tests/assets/model_writers.h"
#include "tests/fuzz/seeds.h"
#include "tests/fuzz/surface_promises.h"
#include "tests/fuzz/targets.h"
#include "tests/fuzz/triangle_soup.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::fuzz {
namespace {

TEST(FuzzTargets, KeepTheirPromisesOnTheSeeds) {
  for (const std::string& seed : scene_seeds()) EXPECT_NO_THROW(try_scene(seed)) << seed;
  for (const std::string& seed : mesh_seeds()) EXPECT_NO_THROW(try_mesh(seed));
  for (const std::string& seed : model_byte_seeds()) EXPECT_NO_THROW(try_model_bytes(seed));
}

/// found/TARGET-ANYTHING: the bytes that broke the target.
TEST(FuzzTargets, KeepTheirPromisesOnWhatOnceBrokeThem) {
  int inputs = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(project_folder() / "tests/fuzz/found")) {
    const std::string name = entry.path().filename().string();
    const std::string target = name.substr(0, name.find('-'));
    const std::string bytes = read_text(entry.path());
    ++inputs;
    if (target == "scene") {
      EXPECT_NO_THROW(try_scene(bytes)) << name;
    } else if (target == "mesh") {
      EXPECT_NO_THROW(try_mesh(bytes)) << name;
    } else if (target == "model_bytes") {
      EXPECT_NO_THROW(try_model_bytes(bytes)) << name;
    } else {
      ADD_FAILURE() << name << " is not called after a target";
    }
  }
  EXPECT_GT(inputs, 0);
}

TEST(TriangleSoup, HoldsAMesh) {
  const sim::TriangleMesh mesh = assets::crooked_box();
  const TriangleSoup soup = decode(encode(soup_of(mesh)));
  const assets::Model model = model_of(soup);
  EXPECT_EQ(model.mesh.triangles, mesh.triangles);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    // Eighths are rounded to.
    EXPECT_LE((model.mesh.vertices[v] - mesh.vertices[v]).cwiseAbs().maxCoeff(), 1.0 / 16.0);
  }
}

/// The fuzzer is worth something only while it gets meshes through.
TEST(TriangleSoup, SomeOfTheSeedsAreSound) {
  int accepted = 0;
  for (const std::string& seed : mesh_seeds()) {
    try {
      assets::clean_mesh(model_of(decode(seed)));
      ++accepted;
    } catch (const assets::ModelError&) {
    }
  }
  EXPECT_GE(accepted, 16);
}

TEST(SurfacePromises, AreKeptByPrimitives) {
  for (const sim::TriangleMesh& mesh :
       {sim::make_sphere(3.0, 8, 8), sim::make_torus(3.0, 1.0, 16, 16), assets::cube()}) {
    EXPECT_EQ(broken_promise(mesh), "");
  }
}

TEST(SurfacePromises, AreFoundBroken) {
  const auto expect = [](const sim::TriangleMesh& mesh, const std::string& words) {
    EXPECT_NE(broken_promise(mesh).find(words), std::string::npos) << broken_promise(mesh);
  };
  sim::TriangleMesh mesh = assets::cube();
  mesh.vertices[3].z() = std::nan("");
  expect(mesh, "vertex 3 is not finite");
  mesh = assets::cube();
  mesh.triangles.pop_back();
  expect(mesh, "no way back");
  mesh = assets::cube();
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  expect(mesh, "is there 2 times");
  mesh = assets::cube();
  for (sim::Triangle& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  expect(mesh, "a volume of -8");
  expect(assets::both(assets::cube(), assets::moved(assets::cube(), {5.0, 0.0, 0.0})),
         "several pieces");
  sim::TriangleMesh pair =
      assets::both(assets::cube(), assets::moved(assets::cube(), {2.0, 2.0, 2.0}));
  const assets::Weld welded = assets::weld(pair.vertices, 1e-6);  // at the corner (1, 1, 1)
  pair.vertices = welded.vertices;
  for (sim::Triangle& triangle : pair.triangles) {
    for (int& v : triangle) v = welded.new_index[sim::at(v)];
  }
  expect(pair, "several fans");
  mesh = sim::make_icosphere(1.0, 2);
  mesh.vertices[0] *= -1.5;  // out at the other side
  expect(mesh, "pierces");
}

}  // namespace
}  // namespace pneuma::fuzz
