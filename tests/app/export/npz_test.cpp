// `pneuma export --format npz`: what NumPy reads is the simulation's own state, bit by bit.
#include <fmt/format.h>

#include <cstring>

#include "app/export/exported_mesh.h"
#include "app/export/npz_run.h"
#include "app/host/errors.h"
#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "scenes/loader/load_scene.h"
#include "tests/app/render/rendered_run.h"
#include "tests/support/run_command.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

const std::string ball_and_boxes = std::string(falling_ball) + R"(
[[body]]
name = "long_name_of_boxes"
kind = "rigid"
copies = [2, 1, 1]
position = [6.0, 0.0, 4.0]
spacing = [4.0, 0.0, 0.0]
tumble = true
)";

/// Debian's own, which has Debian's NumPy; others may come first in PATH.
constexpr const char* python = "/usr/bin/python3";

/// Reads every array, and with it checks every CRC; says type and shape; leaves the raw values.
constexpr const char* reader = R"(
import sys, numpy
run = numpy.load(sys.argv[1])
for name in run.files:
    array = run[name]
    open(name + '.raw', 'wb').write(array.tobytes())
    print(name, array.dtype.str, *array.shape)
start, count = run['first_vertex'], run['first_triangle']
for body, name in enumerate(run['bodies']):
    mine = run['triangles'][count[body]:count[body + 1]]
    assert mine.min() == start[body] and mine.max() == start[body + 1] - 1
    print(name.decode())
)";

class NpzTest : public RenderTest {
 protected:
  NpzTest() { write_text(scene(), ball_and_boxes); }

  ProgramResult run_export(const std::string& options) const {
    return run_pneuma(fmt::format("export '{}' --out '{}' --format npz {} 2>&1", scene().string(),
                                  out().string(), options),
                      "PNEUMA_GL=none");
  }

  template <class Value>
  std::vector<Value> raw(const std::string& name) const {
    const std::string bytes = read_text(out() / (name + ".raw"));
    std::vector<Value> values(bytes.size() / sizeof(Value));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
};

TEST_F(NpzTest, NumpyReadsTheStateBitByBit) {
  if (run_command(fmt::format("{} -c 'import numpy' 2>&1", python)).exit_code != 0) {
    GTEST_SKIP() << "python3-numpy is not installed";
  }
  ASSERT_EQ(run_export("--frames 2-5").exit_code, 0);
  write_text(out() / "read.py", reader);
  const auto said =
      run_command(fmt::format("cd '{}' && {} read.py fall.npz 2>&1", out().string(), python));
  ASSERT_EQ(said.exit_code, 0) << said.output;

  const scenes::Scene loaded = scenes::load_scene(scene());
  Simulation simulation(loaded, build_world(loaded), 1);
  const MeshExporter exporter(loaded, simulation.world());
  std::vector<double> positions;
  std::vector<double> times;
  for (; simulation.frame() <= 5; simulation.advance_frame()) {
    if (simulation.frame() < 2) continue;
    times.push_back(sim::time(simulation.world()));
    for (const ExportedMesh& mesh : exporter.meshes(simulation.world())) {
      for (const sim::Vec3& vertex : mesh.vertices) {
        positions.insert(positions.end(), {vertex.x(), vertex.y(), vertex.z()});
      }
    }
  }
  EXPECT_EQ(raw<double>("positions"), positions);
  EXPECT_EQ(raw<double>("times"), times);

  const std::vector<ExportedMesh> meshes = exporter.meshes(simulation.world());
  std::vector<std::int32_t> triangles;
  std::int32_t vertices = 0;
  for (const ExportedMesh& mesh : meshes) {
    for (const auto& triangle : *mesh.triangles) {
      for (const int v : triangle) triangles.push_back(vertices + v);
    }
    vertices += static_cast<std::int32_t>(mesh.vertices.size());
  }
  EXPECT_EQ(raw<std::int32_t>("triangles"), triangles);
  EXPECT_EQ(said.output,
            fmt::format("positions <f8 4 {} 3\ntimes <f8 4\ntriangles <i4 {} 3\nbodies |S{} 3\n"
                        "first_vertex <i8 4\nfirst_triangle <i8 4\n{}\n{}\n{}\n",
                        vertices, triangles.size() / 3, meshes[1].name.size(), meshes[0].name,
                        meshes[1].name, meshes[2].name));
}

TEST_F(NpzTest, TheSameRunGivesTheSameBytes) {
  ASSERT_EQ(run_export("--frames 3").exit_code, 0);
  const std::string first = read_text(out() / "fall.npz");
  EXPECT_EQ(run_export("--frames 3").exit_code, 6) << "there is one already";
  ASSERT_EQ(run_export("--frames 3 --overwrite --threads 2").exit_code, 0);
  EXPECT_EQ(read_text(out() / "fall.npz"), first);
}

TEST_F(NpzTest, RefusesWhatDoesNotFitIntoAnArchive) {
  EXPECT_NO_THROW(check_npz_size(1000, 89478));
  EXPECT_THROW(check_npz_size(1000, 89479), UsageError);  // 24 bytes each: over 2 GiB
  const ProgramResult animated = run_export("--animated");
  EXPECT_EQ(animated.exit_code, 2);
  EXPECT_NE(animated.output.find("npz has all frames without the option"), std::string::npos);
}

}  // namespace
}  // namespace pneuma::app
