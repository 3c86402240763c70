#include "app/export/point_cache.h"

#include <fmt/format.h>

#include <memory>

#include "app/export/mesh_formats.h"
#include "app/host/version.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

/// All bodies as one, in the order in which the cache has their vertices.
ExportedMesh joined(const std::vector<ExportedMesh>& meshes, const std::string& name) {
  ExportedMesh whole{name, {}, {}, {}};
  std::vector<sim::Triangle> triangles;
  std::vector<render::Colour> colours;
  for (const ExportedMesh& mesh : meshes) {
    const auto first = static_cast<int>(whole.vertices.size());
    for (const auto& [a, b, c] : *mesh.triangles) {
      triangles.push_back({first + a, first + b, first + c});
    }
    whole.vertices.insert(whole.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    colours.insert(colours.end(), mesh.colours->begin(), mesh.colours->end());
  }
  whole.triangles = std::make_shared<const std::vector<sim::Triangle>>(std::move(triangles));
  whole.colours = std::make_shared<const std::vector<render::Colour>>(std::move(colours));
  return whole;
}

}  // namespace

PointCache::PointCache(const ExportJob& job)
    : exporter_(job.scene, job.start),
      object_(job.folder / (job.scene.name + ".obj")),
      cache_(job.folder / (job.scene.name + ".pc2")),
      name_(one_line(job.scene.name)) {}

void PointCache::add(const Simulation& simulation) {
  const std::vector<ExportedMesh> meshes = exporter_.meshes(simulation.world());
  if (frames_ == 0) {
    const ExportedMesh whole = joined(meshes, name_);
    vertices_ = static_cast<std::int32_t>(whole.vertices.size());
    const std::string comment = fmt::format(
        "{}, pneuma {}. Blender: import with forward axis Y, up axis Z; add a Mesh Cache modifier "
        "with {}",
        name_, version().program, cache_.filename().string());
    first_frame_ = encode_obj({&whole, 1}, comment);
  }
  ++frames_;
  for (const ExportedMesh& mesh : meshes) {
    for (const sim::Vec3& vertex : mesh.vertices) {
      for (int axis = 0; axis < 3; ++axis) put(samples_, static_cast<float>(vertex[axis]));
    }
  }
}

std::filesystem::path PointCache::finish() {
  Bytes file;
  put(file, std::string("POINTCACHE2\0", 12));
  put(file, std::int32_t{1});  // version
  put(file, vertices_);
  put(file, 0.0f);  // first frame
  put(file, 1.0f);  // frames from one sample to the next
  put(file, frames_);
  file.insert(file.end(), samples_.begin(), samples_.end());
  base::write_file_atomically(object_.string(), first_frame_);
  base::write_file_atomically(cache_.string(), file);
  return object_;
}

}  // namespace pneuma::app
