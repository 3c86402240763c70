// `pneuma export`: mesh files that read back to the simulation's own state.
#include <fmt/format.h>

#include <cstring>
#include <sstream>

#include "app/export/exported_mesh.h"
#include "app/export/mesh_formats.h"
#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "scenes/loader/load_scene.h"
#include "tests/app/render/rendered_run.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sim::Vec3;

const std::string ball_and_cubes = std::string(falling_ball) + R"(
[[body]]
name = "cube"
kind = "rigid"
copies = [2, 1, 1]
position = [6.0, 0.0, 4.0]
spacing = [4.0, 0.0, 0.0]
tumble = true
)";

class ExportTest : public RenderTest {
 protected:
  ExportTest() { write_text(scene(), ball_and_cubes); }

  ProgramResult run_export(const std::string& options, const std::string& environment = "") const {
    return run_pneuma(
        fmt::format("export '{}' --out '{}' {} 2>&1", scene().string(), out().string(), options),
        environment);
  }
  std::string file(const std::string& name) const { return read_text(out() / name); }

  /// The bodies of a frame, simulated here.
  std::vector<ExportedMesh> meshes_at(int frame) const {
    const scenes::Scene loaded = scenes::load_scene(scene());
    Simulation simulation(loaded, build_world(loaded), 1);
    while (simulation.frame() < frame) simulation.advance_frame();
    return MeshExporter(loaded, simulation.world()).meshes(simulation.world());
  }
};

template <typename Value>
Value take(const std::string& bytes, std::size_t& offset) {
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  offset += sizeof value;
  return value;
}

TEST_F(ExportTest, PlyHasTheStateBitByBit) {
  ASSERT_EQ(run_export("--frames 10-12").exit_code, 0);
  const std::string bytes = file("fall_00011.ply");
  const std::string end = "end_header\n";
  std::size_t at = bytes.find(end) + end.size();
  const std::string header = bytes.substr(0, at);
  EXPECT_NE(header.find("element vertex 74\n"), std::string::npos) << header;  // 58 + 2 * 8
  EXPECT_NE(header.find("element face 136\n"), std::string::npos) << header;   // 112 + 2 * 12
  EXPECT_NE(header.find("comment body 1 cube.1\n"), std::string::npos) << header;
  const auto expected = meshes_at(11);
  ASSERT_EQ(expected.size(), 3u);
  for (std::size_t body = 0; body < 3; ++body) {
    for (const Vec3& vertex : expected[body].vertices) {
      for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(take<double>(bytes, at), vertex[axis]);
      at += 3;
      ASSERT_EQ(take<std::int32_t>(bytes, at), static_cast<std::int32_t>(body));
    }
  }
  int first = 0;
  for (const ExportedMesh& mesh : expected) {
    for (const sim::Triangle& triangle : *mesh.triangles) {
      ASSERT_EQ(take<std::uint8_t>(bytes, at), 3);
      for (const int v : triangle) ASSERT_EQ(take<std::int32_t>(bytes, at), first + v);
    }
    first += static_cast<int>(mesh.vertices.size());
  }
  EXPECT_EQ(at, bytes.size());
}

TEST_F(ExportTest, ObjReadsBackExactly) {
  ASSERT_EQ(run_export("--format obj --frames 5-5").exit_code, 0);
  std::istringstream text(file("fall_00005.obj"));
  std::vector<Vec3> vertices;
  std::vector<std::string> objects;
  int triangles = 0;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      Vec3 v;
      for (int axis = 0; axis < 3; ++axis) {
        words >> word;
        v[axis] = std::stod(word);
      }
      vertices.push_back(v);
    }
    if (word == "o") objects.push_back(line.substr(2));
    triangles += line.starts_with("f ") ? 1 : 0;
  }
  EXPECT_EQ(objects, (std::vector<std::string>{"ball", "cube.1", "cube.2"}));
  EXPECT_EQ(triangles, 136);
  std::vector<Vec3> expected;
  for (const ExportedMesh& mesh : meshes_at(5)) {
    expected.insert(expected.end(), mesh.vertices.begin(), mesh.vertices.end());
  }
  EXPECT_EQ(vertices, expected);
}

TEST_F(ExportTest, GlbIsAWholeContainer) {
  ASSERT_EQ(run_export("--format glb --frames 1").exit_code, 0);
  const std::string bytes = file("fall_00000.glb");
  std::size_t at = 4;
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(take<std::uint32_t>(bytes, at), 2u);
  EXPECT_EQ(take<std::uint32_t>(bytes, at), bytes.size());
  const auto json_size = take<std::uint32_t>(bytes, at);
  EXPECT_EQ(json_size % 4, 0u);
  EXPECT_EQ(bytes.substr(at, 4), "JSON");
  const json gltf = json::parse(bytes.substr(at + 4, json_size));
  at += 4 + json_size;
  const auto binary_size = take<std::uint32_t>(bytes, at);
  EXPECT_EQ(bytes.substr(at, 4), std::string("BIN\0", 4));
  const std::size_t binary = at + 4;
  EXPECT_EQ(binary + binary_size, bytes.size());
  EXPECT_EQ(gltf["buffers"][0]["byteLength"], binary_size);

  const auto expected = meshes_at(0);
  ASSERT_EQ(gltf["meshes"].size(), 3u);
  for (std::size_t body = 0; body < 3; ++body) {
    EXPECT_EQ(gltf["meshes"][body]["name"], expected[body].name);
    const json& primitive = gltf["meshes"][body]["primitives"][0];
    const json& positions =
        gltf["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    ASSERT_EQ(positions["count"], expected[body].vertices.size());
    const json& view = gltf["bufferViews"][positions["bufferView"].get<std::size_t>()];
    std::size_t offset = binary + view["byteOffset"].get<std::size_t>();
    for (const Vec3& vertex : expected[body].vertices) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto value = take<float>(bytes, offset);
        ASSERT_EQ(value, static_cast<float>(vertex[static_cast<int>(axis)]));
        ASSERT_GE(value, positions["min"][axis].get<float>());
        ASSERT_LE(value, positions["max"][axis].get<float>());
      }
    }
    const json& indices = gltf["accessors"][primitive["indices"].get<std::size_t>()];
    EXPECT_EQ(indices["count"], 3 * expected[body].triangles->size());
  }
}

TEST_F(ExportTest, DoesNotReplaceASequenceUnasked) {
  ASSERT_EQ(run_export("--frames 4").exit_code, 0);
  const ProgramResult again = run_export("--frames 2");
  EXPECT_EQ(again.exit_code, 6);
  EXPECT_NE(again.output.find("--overwrite"), std::string::npos) << again.output;
  write_text(out() / "fall_notes.ply", "mine");
  EXPECT_EQ(run_export("--frames 2 --overwrite").exit_code, 0);
  EXPECT_TRUE(fs::exists(out() / "fall_00001.ply"));
  EXPECT_FALSE(fs::exists(out() / "fall_00003.ply"));
  EXPECT_EQ(file("fall_notes.ply"), "mine");
}

TEST_F(ExportTest, NeedsNoGlAndSaysWhatIsWrong) {
  EXPECT_EQ(run_export("--frames 1", "PNEUMA_GL=none").exit_code, 0);
  EXPECT_EQ(run_export("--format stl").exit_code, 2);
  const fs::path page = folder_ / "page.html";
  const ProgramResult file = run_pneuma(
      fmt::format("export '{}' --format html --out '{}' 2>&1", scene().string(), page.string()));
  EXPECT_EQ(file.exit_code, 2);
  EXPECT_NE(file.output.find("name a folder, such as "), std::string::npos) << file.output;
  EXPECT_FALSE(fs::exists(page));
  EXPECT_EQ(run_export("--frames 100-").exit_code, 2);
  EXPECT_EQ(run_export("--set body.k=-1").exit_code, 3);
  EXPECT_EQ(
      run_export(
          "--overwrite --set ball.k=5000 --set ball.k_max=1e9 --set simulation.steps_per_second=60")
          .exit_code,
      5);
}

}  // namespace
}  // namespace pneuma::app
