// A run as arrays for Python: NAME.npz, which numpy.load reads.
#pragma once

#include <cstdint>
#include <filesystem>

#include "app/export/export_formats.h"
#include "app/export/exported_mesh.h"
#include "app/export/sink/bytes.h"

namespace pneuma::app {

/// Of F frames, V vertices, T triangles and B bodies, soft ones first:
///   positions      (F, V, 3) double, m
///   times          (F) double, s
///   triangles      (T, 3) 32-bit numbers of vertices, counter-clockwise from outside
///   bodies         (B) names, ASCII bytes
///   first_vertex   (B + 1): body b has the vertices first_vertex[b] to first_vertex[b + 1] - 1
///   first_triangle (B + 1): its triangles likewise
class NpzRun : public FrameSink {
 public:
  explicit NpzRun(const ExportJob& job);

  void add(const Simulation& simulation) override;
  std::filesystem::path finish() override;

 private:
  MeshExporter exporter_;
  std::vector<ExportedMesh> start_;
  std::filesystem::path file_;
  Bytes positions_;
  Bytes times_;
};

/// Throws UsageError when the positions would not fit into one file.
void check_npz_size(std::int64_t vertices, std::int64_t frames);

}  // namespace pneuma::app
