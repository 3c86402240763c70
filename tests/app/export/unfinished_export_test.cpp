// `pneuma export` that ends before its last frame: what is on disk then.
#include <fmt/format.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "app/export/export_scene.h"
#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "tests/app/render/rendered_run.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string diverging =
    " --set ball.k=5000 --set ball.k_max=1e9 --set simulation.steps_per_second=60";

class UnfinishedExport : public RenderTest {
 protected:
  std::string file(const std::string& name) const { return read_text(out() / name); }
};

/// Of a GLB file, its first part.
json gltf_in(const std::string& bytes) {
  std::uint32_t size = 0;
  std::memcpy(&size, bytes.substr(12, sizeof size).data(), sizeof size);
  return json::parse(bytes.substr(20, size));
}

/// As the format it is made of, but asks the program to stop after the third frame.
class StoppedSink : public FrameSink {
 public:
  explicit StoppedSink(std::unique_ptr<FrameSink> sink) : sink_(std::move(sink)) {}
  void add(const Simulation& simulation) override {
    sink_->add(simulation);
    if (++frames_ == 3) std::raise(SIGINT);
  }
  fs::path finish() override { return sink_->finish(); }

 private:
  std::unique_ptr<FrameSink> sink_;
  int frames_ = 0;
};

template <bool Animated>
std::unique_ptr<FrameSink> open_stopped(const ExportJob& job) {
  return std::make_unique<StoppedSink>(export_format(Animated ? "glb" : "vtp", Animated).open(job));
}

/// The process that exports ends as the program does.
void export_until_stopped(ExportRequest request) {
  request.quiet = true;
  catch_signals();
  try {
    export_scene(request);
  } catch (const Interrupted&) {
    std::exit(130);
  }
  std::exit(0);
}

TEST_F(UnfinishedExport, AnInterruptedRunHasItsFramesSoFar) {
  ExportRequest request;
  request.scene = scene().string();
  request.out = out().string();
  request.format = export_format("glb", true);
  request.format.open = open_stopped<true>;
  EXPECT_EXIT(export_until_stopped(request), testing::ExitedWithCode(130),
              "partial: 3 of [0-9]+ frames, up to t = [0-9.]+ s");
  const json gltf = gltf_in(file("fall.glb"));
  EXPECT_EQ(gltf["meshes"][0]["primitives"][0]["targets"].size(), 2u);

  request.format = export_format("vtp", false);
  request.format.open = open_stopped<false>;
  EXPECT_EXIT(export_until_stopped(request), testing::ExitedWithCode(130), "");
  EXPECT_NE(file("fall.pvd").find("fall_00002.vtp"), std::string::npos);
}

TEST_F(UnfinishedExport, ADivergedRunNamesTheFileThatItLeaves) {
  for (const char* format : {"glb", "obj"}) {
    const ProgramResult result =
        run_pneuma(fmt::format("export '{}' --out '{}' --animated --format {} {} 2>/dev/null",
                               scene().string(), out().string(), format, diverging));
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_EQ(result.output, (out() / fmt::format("fall.{}\n", format)).string());
  }
}

TEST_F(UnfinishedExport, OldFilesAreThereUntilNewOnesReplaceThem) {
  const auto run_export = [&](const char* format, const std::string& options) {
    return run_pneuma(fmt::format("export '{}' --out '{}' --format {} {} 2>&1", scene().string(),
                                  out().string(), format, options))
        .exit_code;
  };
  const std::array formats = {"glb --animated", "obj --animated", "html"};
  for (const char* format : formats) ASSERT_EQ(run_export(format, "--frames 3"), 0);
  const std::array<const char*, 4> names = {"fall.glb", "fall.obj", "fall.pc2", "fall.html"};
  std::vector<std::string> old;
  for (const char* name : names) old.push_back(file(name));
  // It diverges before the first frame that is asked for.
  for (const char* format : formats) {
    EXPECT_EQ(run_export(format, "--overwrite --frames 20-20" + diverging), 5);
  }
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_TRUE(file(names[i]) == old[i]) << names[i];
}

}  // namespace
}  // namespace pneuma::app
