// An OBJ file of the first frame and a PC2 file of all frames' vertices: Blender's Mesh Cache.
#pragma once

#include <filesystem>
#include <string>

#include "app/export/export_formats.h"
#include "app/export/exported_mesh.h"
#include "app/export/sink/bytes.h"

namespace pneuma::app {

/// NAME.obj has all bodies as one object, and NAME.pc2 its vertices frame by frame, in single
/// precision: within 6e-8 of each coordinate.
class PointCache : public FrameSink {
 public:
  explicit PointCache(const ExportJob& job);

  void add(const Simulation& simulation) override;
  std::filesystem::path finish() override;

 private:
  MeshExporter exporter_;
  std::filesystem::path object_;
  std::filesystem::path cache_;
  std::string name_;
  Bytes first_frame_;  // as OBJ
  Bytes samples_;
  std::int32_t frames_ = 0;
  std::int32_t vertices_ = 0;
};

}  // namespace pneuma::app
