#include "app/export/animated_glb.h"

#include <fmt/format.h>

#include "app/export/glb_writer.h"
#include "app/export/mesh_formats.h"
#include "app/host/errors.h"
#include "app/host/version.h"
#include "sim/base/file.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"

namespace pneuma::app {
namespace {

using Eigen::Vector3f;

/// GLB counts bytes in 32 bits; what reads such files keeps them in memory several times over.
constexpr double max_bytes = 1e9;

void check_size(const ExportJob& job) {
  double vertices = 0.0;
  for (const sim::SoftBody& body : job.start.soft) vertices += body.positions.size();
  const auto frames = static_cast<double>(job.frames);
  const auto boxes = static_cast<double>(job.start.rigid.size());
  // Positions and normals; a weight per morph target; positions and orientations of boxes.
  const double weights = job.start.soft.empty() ? 0.0 : frames;
  const double bytes = frames * (24.0 * vertices + weights + 28.0 * boxes);
  if (bytes <= max_bytes) return;
  throw UsageError(fmt::format(
      "--animated: {} frames of {} vertices of soft bodies and {} boxes make a file of "
      "{:.1f} GB; allowed is {:.0f} GB. Choose fewer with --frames, or fewer a second with --set "
      "picture.frames_per_second=N",
      job.frames, vertices, boxes, 1e-9 * bytes, 1e-9 * max_bytes));
}

std::vector<Vector3f> normals_of(const sim::SoftBody& body) {
  std::vector<sim::Vec3> normals;
  sim::vertex_normals(body.mesh->topology, body.positions, normals);
  return single_precision(normals);
}

std::vector<Vector3f> differences_from(const std::vector<Vector3f>& base,
                                       const std::vector<Vector3f>& values) {
  std::vector<Vector3f> differences;
  for (std::size_t v = 0; v < base.size(); ++v) differences.emplace_back(values[v] - base[v]);
  return differences;
}

/// In frame i the target i - 1 alone; in frame 0 none, as the mesh is the first frame's.
Bytes morph_weights(std::size_t frames) {
  Bytes weights(frames * (frames - 1), 0);
  for (std::size_t frame = 1; frame < frames; ++frame) {
    weights[frame * (frames - 1) + frame - 1] = 255;
  }
  return weights;
}

}  // namespace

AnimatedGlb::AnimatedGlb(const ExportJob& job)
    : exporter_(job.scene, job.start),
      file_(job.folder / (job.scene.name + ".glb")),
      comment_(one_line(fmt::format("{}, pneuma {}", job.scene.name, version().program))),
      soft_(job.start.soft.size()),
      boxes_(job.start.rigid.size()) {
  check_size(job);
}

void AnimatedGlb::add(const Simulation& simulation) {
  const sim::World& world = simulation.world();
  if (times_.empty()) {
    start_ = sim::time(world);
    first_ = exporter_.meshes(world);
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
      first_[soft_.size() + b].vertices = sim::make_box(world.rigid[b].size, 1).vertices;
      boxes_[b].last = world.rigid[b].orientation;
    }
  }
  times_.push_back(static_cast<float>(sim::time(world) - start_));
  for (std::size_t b = 0; b < soft_.size(); ++b) {
    const sim::SoftBody& body = world.soft[b];
    Vectors positions;
    for (int v = 0; v < body.positions.size(); ++v) {
      positions.emplace_back(sim::Vec3(body.positions[v]).cast<float>());
    }
    soft_[b].positions.push_back(std::move(positions));
    soft_[b].normals.push_back(normals_of(body));
  }
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const sim::RigidBox& box = world.rigid[b];
    // Of the two quaternions of one orientation the one nearer to the last frame's.
    const double sign = box.orientation.dot(boxes_[b].last) < 0.0 ? -1.0 : 1.0;
    boxes_[b].last.coeffs() = sign * box.orientation.coeffs();
    for (int i = 0; i < 3; ++i) {
      boxes_[b].positions.push_back(static_cast<float>(box.position[i]));
    }
    for (const double value : boxes_[b].last.coeffs()) {
      boxes_[b].orientations.push_back(static_cast<float>(value));
    }
  }
}

std::filesystem::path AnimatedGlb::finish() {
  GlbWriter writer(comment_);
  const bool moves = times_.size() > 1;
  const std::size_t times = moves ? writer.add_series(times_, "SCALAR") : 0;
  const bool morphs = moves && !soft_.empty();
  const std::size_t weights = morphs ? writer.add_fractions(morph_weights(times_.size())) : 0;
  for (std::size_t b = 0; b < soft_.size(); ++b) {
    const SoftFrames& frames = soft_[b];
    const std::size_t mesh = writer.add_mesh(first_[b], frames.normals.front());
    for (std::size_t frame = 1; frame < times_.size(); ++frame) {
      writer.add_morph_target(mesh,
                              differences_from(frames.positions.front(), frames.positions[frame]),
                              differences_from(frames.normals.front(), frames.normals[frame]));
    }
    const std::size_t node = writer.add_node(first_[b].name, mesh);
    if (moves) writer.animate(node, "weights", times, weights);
  }
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    const BoxFrames& frames = boxes_[b];
    const ExportedMesh& mesh = first_[soft_.size() + b];
    const std::size_t node = writer.add_node(mesh.name, writer.add_mesh(mesh));
    writer.place(node, std::span(frames.positions).first<3>(),
                 std::span(frames.orientations).first<4>());
    if (!moves) continue;
    writer.animate(node, "translation", times, writer.add_series(frames.positions, "VEC3"));
    writer.animate(node, "rotation", times, writer.add_series(frames.orientations, "VEC4"));
  }
  base::write_file_atomically(file_.string(), writer.bytes());
  return file_;
}

}  // namespace pneuma::app
