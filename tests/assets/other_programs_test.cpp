// Files that other programs wrote, from Debian's package assimp-testmodels.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "assets/load_model.h"
#include "assets/model_file.h"

namespace pneuma::assets {
namespace {

namespace fs = std::filesystem;

const fs::path models = "/usr/share/assimp/models";

class OtherPrograms : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(models)) GTEST_SKIP() << "the package assimp-testmodels is not installed";
  }
};

TEST_F(OtherPrograms, UnitCubesAreUnitCubes) {
  for (const char* name :
       {"OBJ/box.obj", "PLY/cube_binary.ply", "PLY/cube.ply", "OFF/Cube.off",
        "glTF2/BoxTextured-glTF/BoxTextured.gltf", "glTF2/BoxTextured-glTF-Binary/BoxTextured.glb",
        "glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf", "Collada/cube_triangulate.dae"}) {
    const CleanModel model = load_model(models / name);
    EXPECT_EQ(model.mesh.vertices.size(), 8u) << name;
    for (const Vec3& v : model.mesh.vertices) {
      // Rounded to 32 bits in the file.
      EXPECT_LT((v.cwiseAbs() - Vec3::Constant(0.5)).norm(), 1e-6) << name;
    }
  }
}

/// How many components the model has, and how many are closed.
std::pair<std::size_t, std::ptrdiff_t> components(const fs::path& path) {
  // Number 1 may be open and refused; any closed one will do to see the list.
  for (int i = 1; i < 40; ++i) {
    try {
      const CleanModel model = load_model(path, {.component = std::to_string(i)});
      return {model.components.size(),
              std::count_if(model.components.begin(), model.components.end(),
                            [](const Component& component) { return component.closed(); })};
    } catch (const ModelError&) {
    }
  }
  return {0, 0};
}

TEST_F(OtherPrograms, ASpiderHasTheSamePartsInEachFormat) {
  const std::pair<std::size_t, std::ptrdiff_t> expected = components(models / "OBJ/spider.obj");
  EXPECT_EQ(expected.first, 18u);
  for (const char* name : {"STL/Spider_ascii.stl", "STL/Spider_binary.stl", "FBX/spider.fbx"}) {
    EXPECT_EQ(components(models / name), expected) << name;
  }
}

TEST_F(OtherPrograms, EveryFileEndsInAMeshOrAMessage) {
  int accepted = 0, refused = 0;
  for (const char* folder :
       {"OBJ", "PLY", "STL", "OFF", "glTF2", "3DS", "Collada", "FBX", "invalid"}) {
    for (const auto& entry : fs::recursive_directory_iterator(models / folder)) {
      // The generator's 250 small files are all alike to this program.
      if (!entry.is_regular_file() || !has_model_ending(entry.path())) continue;
      if (entry.path().string().find("glTF-Asset-Generator") != std::string::npos) continue;
      try {
        EXPECT_FALSE(load_model(entry.path()).mesh.triangles.empty()) << entry.path();
        ++accepted;
      } catch (const ModelError& error) {
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with(entry.path().string() + ":")) << message;
        EXPECT_EQ(message.find("broke down"), message.npos) << message;
        ++refused;
      }
    }
  }
  EXPECT_GT(accepted, 30);
  EXPECT_GT(refused, 30);
}

}  // namespace
}  // namespace pneuma::assets
