// VTK's XML files for ParaView: a file of polygons per frame, and one that has their times.
#pragma once

#include <filesystem>
#include <string>

#include "app/export/export_formats.h"
#include "app/export/exported_mesh.h"

namespace pneuma::app {

/// NAME_00042.vtp and so on in double precision, with the arrays `velocity` (m/s), `body` (its
/// number, soft bodies first) and `colour` (sRGB); NAME.pvd is what ParaView opens.
class VtkSeries : public FrameSink {
 public:
  explicit VtkSeries(const ExportJob& job);

  void add(const Simulation& simulation) override;
  std::filesystem::path finish() override;

 private:
  MeshExporter exporter_;
  std::filesystem::path folder_;
  std::string name_;
  std::string entries_;  // of the frames so far
};

}  // namespace pneuma::app
