// `pneuma export` into files that play: each frame reads back to the simulation's own state.
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <regex>

#include "app/export/export_formats.h"
#include "app/export/exported_mesh.h"
#include "app/host/errors.h"
#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "scenes/loader/load_scene.h"
#include "tests/app/export/read_replay.h"
#include "tests/app/render/rendered_run.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using sim::Vec3;

const std::string ball_and_tumbling_box = std::string(falling_ball) + R"(
[[body]]
name = "box"
kind = "rigid"
position = [0.0, 3.0, 4.0]
velocity = [1.0, 0.0, 0.0]
angular_velocity = [3.0, 2.0, 1.0]
)";
constexpr int first_frame = 2;
constexpr int frame_count = 17;

class AnimatedTest : public RenderTest {
 protected:
  AnimatedTest() { write_text(scene(), ball_and_tumbling_box); }

  void run_export(const std::string& options) const {
    const ProgramResult result =
        run_pneuma(fmt::format("export '{}' --out '{}' --frames {}-{} {} 2>&1", scene().string(),
                               out().string(), first_frame, first_frame + frame_count - 1, options),
                   "PNEUMA_GL=none");
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  std::string file(const std::string& name) const { return read_text(out() / name); }

  /// Calls `check(frame, world, meshes)` for each frame that was exported, from 0.
  template <class Check>
  void for_each_frame(const Check& check) const {
    const scenes::Scene loaded = scenes::load_scene(scene());
    Simulation simulation(loaded, build_world(loaded), 1);
    const MeshExporter exporter(loaded, simulation.world());
    while (simulation.frame() < first_frame) simulation.advance_frame();
    for (int frame = 0; frame < frame_count; ++frame) {
      check(static_cast<std::size_t>(frame), simulation.world(),
            exporter.meshes(simulation.world()));
      simulation.advance_frame();
    }
  }
};

template <class Value>
std::vector<Value> values_at(const std::string& bytes, std::size_t offset, std::size_t count) {
  std::vector<Value> values(count);
  if (offset + count * sizeof(Value) > bytes.size()) throw std::runtime_error("the file is short");
  std::memcpy(values.data(), bytes.data() + offset, count * sizeof(Value));
  return values;
}

/// A GLB file, whose accessors are read as numbers.
class ReadGlb {
 public:
  explicit ReadGlb(std::string bytes) : bytes_(std::move(bytes)) {
    const auto json_size = values_at<std::uint32_t>(bytes_, 12, 1)[0];
    gltf = json::parse(bytes_.substr(20, json_size));
    binary_ = 20 + json_size + 8;
  }

  std::vector<float> accessor(const json& number) const {
    const json& accessor = gltf["accessors"][number.get<std::size_t>()];
    const json& view = gltf["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t offset = binary_ + view["byteOffset"].get<std::size_t>();
    const std::map<std::string, std::size_t> widths = {{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}};
    const std::size_t count =
        accessor["count"].get<std::size_t>() * widths.at(accessor["type"].get<std::string>());
    if (accessor["componentType"] == 5126) return values_at<float>(bytes_, offset, count);
    std::vector<float> fractions;
    for (const std::uint8_t byte : values_at<std::uint8_t>(bytes_, offset, count)) {
      fractions.push_back(static_cast<float>(byte) / 255.0f);
    }
    return fractions;
  }

  /// What moves the node along the path.
  json sampler(std::size_t node, const std::string& path) const {
    for (const json& channel : gltf["animations"][0]["channels"]) {
      if (channel["target"] == json{{"node", node}, {"path", path}}) {
        return gltf["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
      }
    }
    throw std::runtime_error("nothing moves the node's " + path);
  }

  json gltf;

 private:
  std::string bytes_;
  std::size_t binary_ = 0;
};

TEST_F(AnimatedTest, GlbPlaysTheRun) {
  run_export("--format glb --animated");
  const ReadGlb glb(file("fall.glb"));
  const json& ball = glb.gltf["meshes"][0]["primitives"][0];
  const std::vector<float> base = glb.accessor(ball["attributes"]["POSITION"]);
  std::vector<std::vector<float>> targets;
  for (const json& target : ball["targets"]) targets.push_back(glb.accessor(target["POSITION"]));
  ASSERT_EQ(targets.size(), frame_count - 1u);
  const json morph = glb.sampler(1, "weights");
  const std::vector<float> times = glb.accessor(morph["input"]);
  const std::vector<float> weights = glb.accessor(morph["output"]);
  const std::vector<float> corners =
      glb.accessor(glb.gltf["meshes"][1]["primitives"][0]["attributes"]["POSITION"]);
  const std::vector<float> places = glb.accessor(glb.sampler(2, "translation")["output"]);
  const std::vector<float> turns = glb.accessor(glb.sampler(2, "rotation")["output"]);

  for_each_frame([&](std::size_t frame, const sim::World&, const std::vector<ExportedMesh>& real) {
    EXPECT_NEAR(times.at(frame), static_cast<double>(frame) / 30.0, 1e-6);
    for (std::size_t i = 0; i < base.size(); ++i) {
      double value = base[i];
      for (std::size_t t = 0; t < targets.size(); ++t) {
        value += static_cast<double>(weights.at(frame * targets.size() + t)) * targets[t].at(i);
      }
      const Vec3& vertex = real[0].vertices[i / 3];
      EXPECT_NEAR(value, vertex[static_cast<int>(i % 3)], 4e-7 * (vertex.norm() + 2.0));
    }
    const float* q = &turns.at(4 * frame);
    const Eigen::Quaterniond turn = Eigen::Quaternionf(q[3], q[0], q[1], q[2]).cast<double>();
    EXPECT_NEAR(turn.norm(), 1.0, 1e-6);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const Vec3 own(corners[3 * corner], corners[3 * corner + 1], corners[3 * corner + 2]);
      const Vec3 place(places.at(3 * frame), places.at(3 * frame + 1), places.at(3 * frame + 2));
      const Vec3 vertex = place + turn * own;
      EXPECT_LE((vertex - real[1].vertices[corner]).norm(), 4e-6);
    }
  });
}

TEST_F(AnimatedTest, GlbTurnsOnTheShortWay) {
  run_export("--format glb --animated");
  const ReadGlb glb(file("fall.glb"));
  const std::vector<float> turns = glb.accessor(glb.sampler(2, "rotation")["output"]);
  for (std::size_t i = 4; i < turns.size(); i += 4) {
    float cosine = 0.0f;
    for (std::size_t j = 0; j < 4; ++j) cosine += turns[i + j] * turns[i - 4 + j];
    EXPECT_GT(cosine, 0.9f);
  }
}

TEST_F(AnimatedTest, GlbOfASingleFrameDoesNotMove) {
  const ProgramResult result =
      run_pneuma(fmt::format("export '{}' --out '{}' --frames 1 --format glb --animated 2>&1",
                             scene().string(), out().string()));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const ReadGlb glb(file("fall.glb"));
  EXPECT_FALSE(glb.gltf["meshes"][0]["primitives"][0].contains("targets"));
  EXPECT_FALSE(glb.gltf.contains("animations"));
  EXPECT_EQ(glb.gltf["nodes"][2]["translation"], (json{0.0, 3.0, 4.0}));
}

/// Of a file with so many frames; throws where it is too large.
void open_glb(const std::string& text, std::int64_t frames) {
  const scenes::Scene loaded = scenes::parse_scene(text, "fall.toml");
  const sim::World start = build_world(loaded);
  Progress progress(Progress::Style::silent);
  export_format("glb", true).open({loaded, start, frames, "", 1, progress});
}

// Only soft bodies need a weight per pair of frames; a box needs 28 bytes per frame.
TEST(AnimatedGlb, IsRefusedBeyondAGigabyte) {
  const std::string box = "[[body]]\nkind = \"rigid\"\nposition = [0, 0, 4]\n";
  EXPECT_NO_THROW(open_glb(box, 35'000'000));
  EXPECT_THROW(open_glb(box, 36'000'000), UsageError);
  EXPECT_NO_THROW(open_glb(falling_ball, 30'000));
  EXPECT_THROW(open_glb(falling_ball, 32'000), UsageError);
}

TEST_F(AnimatedTest, PointCacheHasEveryFrame) {
  run_export("--format obj --animated");
  const std::string bytes = file("fall.pc2");
  EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
  const auto whole = values_at<std::int32_t>(bytes, 12, 5);
  const auto fractions = values_at<float>(bytes, 12, 5);
  EXPECT_EQ(whole[0], 1);  // version
  EXPECT_EQ(whole[1], 58 + 8);
  EXPECT_EQ(fractions[2], 0.0f);  // first frame
  EXPECT_EQ(fractions[3], 1.0f);  // frames from one to the next
  EXPECT_EQ(whole[4], frame_count);
  std::size_t at = 32;
  for_each_frame([&](std::size_t, const sim::World&, const std::vector<ExportedMesh>& real) {
    for (const ExportedMesh& mesh : real) {
      for (const Vec3& vertex : mesh.vertices) {
        const auto read = values_at<float>(bytes, at, 3);
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_EQ(read[static_cast<std::size_t>(axis)], static_cast<float>(vertex[axis]));
        }
        at += 12;
      }
    }
  });
  EXPECT_EQ(at, bytes.size());
  const std::string object = file("fall.obj");
  const std::regex vertex("\nv "), begin("\no ");
  const auto count = [&](const std::regex& line) {
    return std::distance(std::sregex_iterator(object.begin(), object.end(), line), {});
  };
  EXPECT_EQ(count(vertex), 58 + 8);
  EXPECT_EQ(count(begin), 1) << "the cache is of one object";
}

/// A data array of a VTP file, without the count of bytes before it.
template <class Value>
std::vector<Value> vtk_array(const std::string& text, const std::string& name) {
  const std::size_t named = text.find("Name=\"" + name + "\"");
  if (named == std::string::npos) throw std::runtime_error("no array " + name);
  const std::size_t begin = text.find('>', named) + 1;
  const std::vector<std::uint8_t> read =
      from_base64(text.substr(begin, text.find('<', begin) - begin));
  const std::string bytes(read.begin(), read.end());
  EXPECT_EQ(values_at<std::uint64_t>(bytes, 0, 1)[0], bytes.size() - 8);
  return values_at<Value>(bytes, 8, (bytes.size() - 8) / sizeof(Value));
}

TEST_F(AnimatedTest, VtkSeriesHasTheStateBitByBit) {
  run_export("--format vtp");
  const std::string collection = file("fall.pvd");
  for_each_frame([&](std::size_t frame, const sim::World& world,
                     const std::vector<ExportedMesh>& real) {
    const std::string name = fmt::format("fall_{:05}.vtp", frame + first_frame);
    EXPECT_NE(
        collection.find(fmt::format("timestep=\"{:.17g}\" file=\"{}\"", sim::time(world), name)),
        std::string::npos);
    const std::string text = file(name);
    const auto points = vtk_array<double>(text, "Points");
    const auto velocities = vtk_array<double>(text, "velocity");
    const auto bodies = vtk_array<std::int32_t>(text, "body");
    EXPECT_EQ(vtk_array<double>(text, "TimeValue"), std::vector<double>{sim::time(world)});
    std::size_t at = 0;
    for (std::size_t body = 0; body < real.size(); ++body) {
      for (const Vec3& vertex : real[body].vertices) {
        for (int axis = 0; axis < 3; ++axis)
          ASSERT_EQ(points.at(3 * at + static_cast<std::size_t>(axis)), vertex[axis]);
        ASSERT_EQ(bodies.at(at++), static_cast<std::int32_t>(body));
      }
    }
    ASSERT_EQ(points.size(), 3 * at);
    const sim::SoftBody& ball = world.soft[0];
    for (int v = 0; v < ball.velocities.size(); ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(velocities.at(3 * static_cast<std::size_t>(v) + static_cast<std::size_t>(axis)),
                  ball.velocities[v][axis]);
      }
    }
    const auto offsets = vtk_array<std::int64_t>(text, "offsets");
    EXPECT_EQ(offsets.size(), 112u + 12u);
    EXPECT_EQ(offsets.back(), 3 * (112 + 12));
    EXPECT_EQ(std::ranges::max(vtk_array<std::int64_t>(text, "connectivity")), 58 + 8 - 1);
  });
}

TEST_F(AnimatedTest, VelocitiesOfABoxMoveItsCorners) {
  run_export(
      "--format vtp --set simulation.steps_per_second=6000 --set picture.frames_per_second=3000");
  const auto before = vtk_array<double>(file("fall_00002.vtp"), "Points");
  const auto after = vtk_array<double>(file("fall_00004.vtp"), "Points");
  const auto velocity = vtk_array<double>(file("fall_00003.vtp"), "velocity");
  for (std::size_t i = std::size_t{3} * 58; i < before.size(); ++i) {
    EXPECT_NEAR((after[i] - before[i]) * 1500.0, velocity[i], 0.02) << i;
  }
}

TEST_F(AnimatedTest, OnlySomeFormatsAreOneFile) {
  const ProgramResult result =
      run_pneuma(fmt::format("export '{}' --animated 2>&1", scene().string()));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.output.find("glb"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace pneuma::app
