// One shape through every format, and what files do beyond that: instances, transforms, units.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <ostream>
#include <vector>

#include "assets/load_model.h"
#include "tests/assets/model_writers.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::assets {
namespace {

using sim::at;
using Corner = std::array<double, 3>;

/// A mesh without its numbering: each triangle begins at its lowest corner, the triangles sorted.
std::vector<std::array<Corner, 3>> canonical(const sim::TriangleMesh& mesh) {
  std::vector<std::array<Corner, 3>> result;
  for (const Triangle& triangle : mesh.triangles) {
    std::array<Corner, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& v = mesh.vertices[at(triangle[i])];
      corners[i] = {v.x(), v.y(), v.z()};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.push_back(corners);
  }
  std::sort(result.begin(), result.end());
  return result;
}

struct FormatCase {
  std::string name;
  std::string ending;
  std::function<std::string(const sim::TriangleMesh&)> write;
};

void PrintTo(const FormatCase& format, std::ostream* out) { *out << format.name; }

/// Before the first word and at the ends of all lines, with empty lines between them.
std::string commented_off_text(const sim::TriangleMesh& mesh) {
  std::string text = "# Output of a tool\n  # in two lines\n\n";
  for (const char c : off_text(mesh)) text += c == '\n' ? " # said here\n\n" : std::string(1, c);
  return text;
}

const FormatCase formats[] = {
    {"obj", ".obj", obj_text},
    {"ply_ascii", ".ply", ply_text},
    {"ply_binary", ".PLY", ply_bytes},
    {"stl_ascii", ".stl", stl_text},
    {"stl_binary", ".Stl", stl_bytes},
    {"off", ".off", off_text},
    {"off_with_comments", ".off", commented_off_text},
    {"gltf", ".gltf", [](const auto& mesh) { return gltf_text(mesh, "it.bin"); }},
    {"glb", ".glb", glb_bytes},
    {"threeds", ".3ds", a3ds_bytes},
    {"dae", ".dae", dae_text},
    {"fbx", ".fbx", fbx_text},
};

class FormatTest : public testing::TestWithParam<FormatCase> {
 protected:
  std::filesystem::path write(const sim::TriangleMesh& mesh) const {
    write_text(folder_ / "it.bin", gltf_buffer(mesh));
    const auto path = folder_ / ("it" + GetParam().ending);
    write_text(path, GetParam().write(mesh));
    return path;
  }

  TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Formats, FormatTest, testing::ValuesIn(formats),
                         [](const auto& format) { return format.param.name; });

// Exact: the coordinates are so in 32 bits, and nothing is done to them.
TEST_P(FormatTest, GivesTheSameMesh) {
  const sim::TriangleMesh expected = crooked_box();
  const CleanModel model = load_model(write(expected), {.centre = false});
  EXPECT_EQ(model.mesh.vertices.size(), expected.vertices.size());
  EXPECT_EQ(canonical(model.mesh), canonical(expected));
}

TEST_P(FormatTest, GivesBackACubeOf24VerticesWith8) {
  const CleanModel model = load_model(write(cube_of_24()), {.centre = false});
  EXPECT_EQ(model.mesh.vertices.size(), 8u);
  EXPECT_EQ(canonical(model.mesh), canonical(cube()));
}

TEST_P(FormatTest, RefusesWhatHasNoTriangles) {
  sim::TriangleMesh points = cube();
  points.triangles.clear();
  EXPECT_THROW(load_model(write(points)), ModelError);
}

TEST(ImportModel, PutsObjectsWhereTheFileSays) {
  const TemporaryFolder folder;
  const auto path = folder / "placed.gltf";
  write_text(folder / "placed.bin", gltf_buffer(cube()));
  std::string text = gltf_text(cube(), "placed.bin");
  // Two instances, each below a node that moves it: the outer by x, the inner by y.
  const std::string one = R"("nodes":[{"mesh":0,"name":"thing"}])";
  const std::string two = R"("nodes":[{"children":[1,2],"translation":[10,0,0]},)"
                          R"({"mesh":0,"name":"low","translation":[0,-5,0]},)"
                          R"({"mesh":0,"name":"high","translation":[0,5,0],"scale":[2,2,2]}])";
  ASSERT_NE(text.find(one), text.npos);
  write_text(path, text.replace(text.find(one), one.size(), two));

  const CleanModel low = load_model(path, {.component = "low", .centre = false});
  EXPECT_EQ(canonical(low.mesh), canonical(moved(cube(), {10.0, -5.0, 0.0})));
  const CleanModel high = load_model(path, {.component = "high", .centre = false});
  EXPECT_EQ(canonical(high.mesh), canonical(moved(scaled(cube(), 2.0), {10.0, 5.0, 0.0})));
  EXPECT_THROW(load_model(path), ModelError) << "two closed components, none named";
}

TEST(ImportModel, ReadsNothingButTheModel) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "below");
  write_text(folder / "secret.bin", gltf_buffer(cube()));
  write_text(folder / "secret.txt", gltf_buffer(cube()));
  const auto path = folder / "below" / "it.gltf";
  for (const char* buffer : {"../secret.bin", "../secret.txt"}) {
    write_text(path, gltf_text(cube(), buffer));
    EXPECT_THROW(load_model(path), ModelError) << buffer;
  }
  write_text(folder / "below" / "secret.bin", gltf_buffer(cube()));
  write_text(path, gltf_text(cube(), "secret.bin"));
  EXPECT_NO_THROW(load_model(path));
}

TEST(ImportModel, CutsPolygonsIntoTriangles) {
  const TemporaryFolder folder;
  // An L drawn upwards: its two ends are polygons of six corners with a notch.
  write_text(folder / "l.obj",
             "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\n"
             "v 0 0 1\nv 4 0 1\nv 4 1 1\nv 1 1 1\nv 1 3 1\nv 0 3 1\n"
             "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n"
             "f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n");
  const CleanModel model = load_model(folder / "l.obj");
  EXPECT_EQ(model.mesh.vertices.size(), 12u);
  EXPECT_EQ(model.mesh.triangles.size(), 20u);  // 2 (V - 2) of a closed surface of genus 0
  EXPECT_DOUBLE_EQ(sim::volume(sim::MeshTopology(12, model.mesh.triangles),
                               sim::to_vertex_array(model.mesh.vertices)),
                   6.0);
}

TEST(ImportModel, SaysOfAnInstancedMillionThatItIsTooMuch) {
  const TemporaryFolder folder;
  write_text(folder / "many.bin", gltf_buffer(cube()));
  std::string nodes = R"("nodes":[{"children":[1)";
  for (int i = 2; i <= 2000; ++i) nodes.append(",").append(std::to_string(i));
  nodes += "]}";
  for (int i = 1; i <= 2000; ++i) nodes += R"(,{"mesh":0})";
  std::string text = gltf_text(cube(), "many.bin");
  const std::string one = R"("nodes":[{"mesh":0,"name":"thing"}])";
  text.replace(text.find(one), one.size(), nodes + "]");
  write_text(folder / "many.gltf", text);
  ImportLimits limits;
  EXPECT_EQ(import_model(folder / "many.gltf", limits).mesh.triangles.size(), 24'000u);
  limits.vertices = 10'000;
  EXPECT_THROW(import_model(folder / "many.gltf", limits), ModelError);
}

}  // namespace
}  // namespace pneuma::assets
