// Limits of model files: what each says, and that it can be raised. Those of scenes that have
// models are in model_scene_test.cpp.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "assets/load_model.h"
#include "tests/assets/model_writers.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::assets {
namespace {

template <class Read>
std::string read_refusal(const Read& read) {
  try {
    read();
  } catch (const ModelError& error) {
    return error.what();
  }
  return "accepted";
}

void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), message.npos) << "'" << part << "' in: " << message;
  }
}

TEST(ModelLimits, FileSize) {
  const TemporaryFolder folder;
  const auto path = folder / "a.obj";
  write_text(path, obj_text(cube()));
  ImportLimits limits;
  limits.bytes = std::filesystem::file_size(path);
  EXPECT_NO_THROW(import_model(path, limits));
  --limits.bytes;
  EXPECT_THROW(import_model(path, limits), ModelError);
  // The default limit, on a file that takes no room on the disk.
  std::filesystem::resize_file(path, (std::size_t{64} << 20) + 1);
  expect_parts(read_refusal([&] { load_model(path); }),
               {"67108865 bytes are more than the limit of 67108864 for a model;",
                "raise model_file_mib in [limits]"});
}

TEST(ModelLimits, FileSizeWithBuffers) {
  const TemporaryFolder folder;
  const std::string text = gltf_text(cube(), "it.bin"), buffer = gltf_buffer(cube());
  write_text(folder / "a.gltf", text);
  write_text(folder / "it.bin", buffer);
  ImportLimits limits;
  limits.bytes = text.size() + buffer.size();
  EXPECT_NO_THROW(import_model(folder / "a.gltf", limits));
  --limits.bytes;
  expect_parts(read_refusal([&] { import_model(folder / "a.gltf", limits); }),
               {fmt::format("{} bytes are more than the limit of {} for a model with its files",
                            limits.bytes + 1, limits.bytes)});
}

TEST(ModelLimits, VerticesInTheFile) {
  const TemporaryFolder folder;
  sim::TriangleMesh mesh = cube();
  mesh.vertices.resize(800'008, Vec3::Zero());  // eight times 100,001, most without triangles
  write_text(folder / "a.ply", ply_bytes(mesh));
  expect_parts(read_refusal([&] { load_model(folder / "a.ply"); }),
               {"800008 vertices are more than the limit of 800000 for a file",
                "raise vertices_per_body in [limits]"});
  EXPECT_EQ(load_model(folder / "a.ply", {.most_vertices = 100'001}).mesh.vertices.size(), 8u);
  EXPECT_EQ(load_model(folder / "a.ply", {.simplify_to = 100}).mesh.vertices.size(), 8u)
      << "what is simplified counts when it is";
}

TEST(ModelLimits, TrianglesWithInstances) {
  const TemporaryFolder folder;
  write_text(folder / "a.obj", obj_text(cube()));
  ImportLimits limits;
  limits.triangles = 12;
  EXPECT_NO_THROW(import_model(folder / "a.obj", limits));
  limits.triangles = 11;
  expect_parts(read_refusal([&] { import_model(folder / "a.obj", limits); }),
               {"more than 11 triangles", "raise vertices_per_body in [limits]"});
}

}  // namespace
}  // namespace pneuma::assets
