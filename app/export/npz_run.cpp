#include "app/export/npz_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/export/npz_writer.h"
#include "app/host/errors.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

/// All bodies as one mesh, and where each begins in it.
struct BodyArrays {
  explicit BodyArrays(const std::vector<ExportedMesh>& meshes) {
    for (const ExportedMesh& mesh : meshes) add(mesh);
    put(first_vertex, vertices);
    put(first_triangle, triangle_count);
  }

  void add(const ExportedMesh& mesh) {
    put(first_vertex, vertices);
    put(first_triangle, triangle_count);
    for (const auto& triangle : *mesh.triangles) {
      for (const int v : triangle) put(triangles, static_cast<std::int32_t>(vertices + v));
    }
    vertices += static_cast<std::int64_t>(mesh.vertices.size());
    triangle_count += static_cast<std::int64_t>(mesh.triangles->size());
  }

  Bytes triangles, first_vertex, first_triangle;
  std::int64_t vertices = 0, triangle_count = 0;
};

void add_names(NpzWriter& writer, const std::vector<ExportedMesh>& meshes) {
  std::size_t width = 1;
  for (const ExportedMesh& mesh : meshes) width = std::max(width, mesh.name.size());
  Bytes names;
  for (const ExportedMesh& mesh : meshes) {
    std::string padded = mesh.name;
    padded.resize(width, '\0');
    put(names, padded);
  }
  writer.add("bodies", fmt::format("|S{}", width), {meshes.size()}, names);
}

}  // namespace

NpzRun::NpzRun(const ExportJob& job)
    : exporter_(job.scene, job.start),
      start_(exporter_.meshes(job.start)),
      file_(job.folder / (job.scene.name + ".npz")) {}

void NpzRun::add(const Simulation& simulation) {
  for (const ExportedMesh& mesh : exporter_.meshes(simulation.world())) {
    for (const sim::Vec3& vertex : mesh.vertices) {
      for (int axis = 0; axis < 3; ++axis) put(positions_, vertex[axis]);
    }
  }
  put(times_, sim::time(simulation.world()));
}

std::filesystem::path NpzRun::finish() {
  const BodyArrays bodies(start_);
  const std::size_t frames = times_.size() / sizeof(double);
  NpzWriter writer;
  writer.add("positions", "<f8", {frames, static_cast<std::size_t>(bodies.vertices), 3},
             positions_);
  writer.add("times", "<f8", {frames}, times_);
  writer.add("triangles", "<i4", {static_cast<std::size_t>(bodies.triangle_count), 3},
             bodies.triangles);
  add_names(writer, start_);
  writer.add("first_vertex", "<i8", {start_.size() + 1}, bodies.first_vertex);
  writer.add("first_triangle", "<i8", {start_.size() + 1}, bodies.first_triangle);
  base::write_file_atomically(file_.string(), writer.finish());
  return file_;
}

void check_npz_size(std::int64_t vertices, std::int64_t frames) {
  // Half of the archive is more than the other arrays need: a vertex has about two triangles.
  const std::int64_t max_frames =
      static_cast<std::int64_t>(max_npz_bytes / 2 / (3 * sizeof(double))) / vertices;
  if (frames <= max_frames) return;
  throw UsageError(fmt::format(
      "--format npz: {} frames of {} vertices are too much for one file; choose up to {} of them "
      "with --frames, or fewer a second with --set picture.frames_per_second=N",
      frames, vertices, max_frames));
}

}  // namespace pneuma::app
