#include "app/export/export_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "app/export/animated_glb.h"
#include "app/export/mesh_formats.h"
#include "app/export/npz_run.h"
#include "app/export/point_cache.h"
#include "app/export/replay/replay_data.h"
#include "app/export/replay/replay_page.h"
#include "app/export/vtk_series.h"
#include "app/host/errors.h"
#include "app/host/version.h"
#include "app/picture/camera_events.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

/// NAME_00042.ply and so on, a file per frame.
class MeshFiles : public FrameSink {
 public:
  MeshFiles(const ExportJob& job, MeshFormat format)
      : exporter_(job.scene, job.start),
        format_(format),
        folder_(job.folder),
        name_(job.scene.name) {}

  void add(const Simulation& simulation) override {
    const sim::World& world = simulation.world();
    const std::string comment =
        fmt::format("{} t = {:.6g} s, pneuma {}", name_, sim::time(world), version().program);
    const fs::path file =
        folder_ / fmt::format("{}_{:05}.{}", name_, simulation.frame(), format_.name);
    base::write_file_atomically(file.string(), format_.encode(exporter_.meshes(world), comment));
  }

  fs::path finish() override { return folder_; }

 private:
  MeshExporter exporter_;
  MeshFormat format_;
  fs::path folder_;
  std::string name_;
};

template <std::size_t Format>
std::unique_ptr<FrameSink> open_mesh_files(const ExportJob& job) {
  return std::make_unique<MeshFiles>(job, mesh_formats[Format]);
}

std::int64_t vertex_count(const sim::World& world) {
  std::int64_t count = 8 * static_cast<std::int64_t>(world.rigid.size());
  for (const sim::SoftBody& body : world.soft) count += body.positions.size();
  return count;
}

std::unique_ptr<FrameSink> open_replay(const ExportJob& job) {
  check_replay_size(vertex_count(job.start), job.frames);
  return std::make_unique<ReplaySink>(job.scene, job.start, job.threads,
                                      camera_events(job.scene, job.progress),
                                      job.folder / (job.scene.name + ".html"));
}

std::unique_ptr<FrameSink> open_npz(const ExportJob& job) {
  check_npz_size(vertex_count(job.start), job.frames);
  return std::make_unique<NpzRun>(job);
}

template <class Sink>
std::unique_ptr<FrameSink> open_sink(const ExportJob& job) {
  return std::make_unique<Sink>(job);
}

constexpr std::array<ExportFormat, 8> formats = {
    {{"ply", false, false, false, R"(_[0-9]{5,}\.ply)", open_mesh_files<0>},
     {"obj", false, false, false, R"(_[0-9]{5,}\.obj)", open_mesh_files<1>},
     {"glb", false, false, false, R"(_[0-9]{5,}\.glb)", open_mesh_files<2>},
     {"vtp", false, false, false, R"(_[0-9]{5,}\.vtp|\.pvd)", open_sink<VtkSeries>},
     {"npz", false, true, false, R"(\.npz)", open_npz},
     {"html", false, true, true, R"(\.html)", open_replay},
     {"obj", true, true, false, R"(\.obj|\.pc2)", open_sink<PointCache>},
     {"glb", true, true, false, R"(\.glb)", open_sink<AnimatedGlb>}}};

}  // namespace

std::span<const ExportFormat> export_formats() { return formats; }

const ExportFormat& export_format(std::string_view name, bool animated) {
  const auto* format = std::ranges::find_if(formats, [&](const ExportFormat& each) {
    return each.name == name && each.animated == animated;
  });
  if (format != formats.end()) return *format;
  if (name == "html" || name == "vtp" || name == "npz") {
    throw UsageError(fmt::format(
        "--animated: {} has all frames without the option; it is for --format glb and obj", name));
  }
  throw UsageError(fmt::format(
      "--animated: {} has no file for all frames; allowed are --format glb and --format obj",
      name));
}

}  // namespace pneuma::app
