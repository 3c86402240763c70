// The parts of a GLB file (glTF 2.0) while they are added.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "app/export/exported_mesh.h"
#include "app/export/sink/bytes.h"

namespace pneuma::app {

class GlbWriter {
 public:
  using Json = nlohmann::ordered_json;

  /// Everything hangs below a node that turns +z to glTF's upward axis, +y.
  explicit GlbWriter(const std::string& comment);

  /// Returns its number. Without normals, programs shade it flat.
  std::size_t add_mesh(const ExportedMesh& mesh, std::span<const Eigen::Vector3f> normals = {});

  /// A further shape of the mesh: by how much it differs from the mesh as it was added.
  void add_morph_target(std::size_t mesh, std::span<const Eigen::Vector3f> displacements,
                        std::span<const Eigen::Vector3f> normal_differences);

  /// Returns the number of the node.
  std::size_t add_node(const std::string& name, std::size_t mesh);

  /// x, y, z in m, and a unit quaternion x, y, z, w.
  void place(std::size_t node, std::span<const float, 3> position,
             std::span<const float, 4> orientation);

  /// Values over time, or the times themselves. Returns the number of the accessor.
  std::size_t add_series(std::span<const float> values, const char* shape);
  /// Fractions of 1 as bytes: numbers 0 or 255.
  std::size_t add_fractions(std::span<const std::uint8_t> values);

  /// Lets `path` ("translation", "rotation", "weights") of a node follow `values`.
  void animate(std::size_t node, const char* path, std::size_t times, std::size_t values);

  Bytes bytes();

 private:
  std::size_t add_view(std::size_t start, int target);
  std::size_t add_accessor(std::size_t view, std::size_t count, int type, const char* shape);
  std::size_t add_vectors(std::span<const Eigen::Vector3f> vectors, bool with_bounds);
  std::size_t add_colours(const std::vector<render::Colour>& colours);
  std::size_t add_indices(const std::vector<sim::Triangle>& triangles);

  Json json_;
  Bytes binary_;
};

std::vector<Eigen::Vector3f> single_precision(std::span<const sim::Vec3> vectors);

}  // namespace pneuma::app
