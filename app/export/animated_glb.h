// One glTF file that plays: soft bodies as morph targets, one per frame, boxes as moving nodes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/export/export_formats.h"
#include "app/export/exported_mesh.h"

namespace pneuma::app {

/// Keeps the run in memory and writes NAME.glb in the end. Between two frames everything moves
/// straight. Coordinates are single precision; a vertex is within 4e-7 of its distance from the
/// origin and from its place in the first frame.
class AnimatedGlb : public FrameSink {
 public:
  /// Throws UsageError for a run that is too long for one file.
  explicit AnimatedGlb(const ExportJob& job);

  void add(const Simulation& simulation) override;
  std::filesystem::path finish() override;

 private:
  using Vectors = std::vector<Eigen::Vector3f>;
  struct SoftFrames {
    std::vector<Vectors> positions;  // m
    std::vector<Vectors> normals;
  };
  struct BoxFrames {
    std::vector<float> positions;     // x, y, z
    std::vector<float> orientations;  // x, y, z, w
    Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
  };

  MeshExporter exporter_;
  std::filesystem::path file_;
  std::string comment_;
  std::vector<ExportedMesh> first_;  // soft bodies, then boxes about their own centres
  std::vector<SoftFrames> soft_;
  std::vector<BoxFrames> boxes_;
  std::vector<float> times_;  // s since the first frame
  double start_ = 0.0;        // s
};

}  // namespace pneuma::app
