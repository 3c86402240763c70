#include "render/frame/check_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pneuma::render {
namespace {

template <typename... Arguments>
void require(bool fine, fmt::format_string<Arguments...> message, Arguments&&... arguments) {
  if (!fine) {
    throw std::invalid_argument(fmt::format(message, std::forward<Arguments>(arguments)...));
  }
}

std::string to_text(const Vec3f& v) { return fmt::format("({}, {}, {})", v.x(), v.y(), v.z()); }

/// Beyond it, products of three coordinates leave float's range.
bool drawable(const Vec3f& position) { return (position.array().abs() < 1e9f).all(); }

void check_vectors(const std::vector<Vec3f>& vectors, std::size_t mesh, const char* what) {
  const auto bad = std::find_if_not(vectors.begin(), vectors.end(), drawable);
  if (bad == vectors.end()) return;
  require(false, "mesh {}: {} {} is {}; it must be finite and below 1e9", mesh, what,
          bad - vectors.begin(), to_text(*bad));
}

template <std::size_t N>
void check_indices(const std::vector<std::array<std::uint32_t, N>>& features,
                   std::size_t vertex_count, std::size_t mesh, const char* what) {
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (const std::uint32_t index : features[i]) {
      require(index < vertex_count, "mesh {}: {} {} names vertex {}, but there are {} vertices",
              mesh, what, i, index, vertex_count);
    }
  }
}

void check_corner_normals(const MeshShape& shape, std::size_t mesh) {
  const auto& normals = shape.corner_normals;
  const std::size_t triangles = shape.triangles.size();
  require(normals.empty() || normals.size() == triangles,
          "mesh {} has {} triangles and normals of the corners of {}; as many are needed, or none",
          mesh, triangles, normals.size());
  constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> vertex_of(3 * normals.size(), none);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t normal = normals[i][corner], vertex = shape.triangles[i][corner];
      require(normal < 3 * triangles,
              "mesh {}: triangle {} has a corner with normal {}; allowed is below {}", mesh, i,
              normal, 3 * triangles);
      std::uint32_t& of = vertex_of[normal];
      if (of == none) of = vertex;
      require(of == vertex, "mesh {}: normal {} is of vertices {} and {}; each is of one", mesh,
              normal, of, vertex);
    }
  }
}

void check_mesh(const Mesh& mesh, std::size_t i) {
  require(mesh.shape != nullptr, "mesh {} has no shape", i);
  const std::size_t vertices = mesh.positions.size();
  require(mesh.shape->colours.size() == vertices,
          "mesh {} has {} positions and {} colours; one of each per vertex is needed", i, vertices,
          mesh.shape->colours.size());
  require(mesh.normals.empty() || mesh.normals.size() == vertices,
          "mesh {} has {} positions and {} normals; as many are needed, or none", i, vertices,
          mesh.normals.size());
  require(mesh.colours.empty() || mesh.colours.size() == vertices,
          "mesh {} has {} positions and {} colours of its own; as many are needed, or none", i,
          vertices, mesh.colours.size());
  require(mesh.roughness >= 0.05f && mesh.roughness <= 1.0f,
          "mesh {}: the roughness is {}; allowed is 0.05..1", i, mesh.roughness);
  require(mesh.room.empty() || mesh.room.size() == mesh.shape->triangles.size(),
          "mesh {} has {} triangles and room for {} to bulge; as many are needed, or none", i,
          mesh.shape->triangles.size(), mesh.room.size());
  require(std::all_of(mesh.room.begin(), mesh.room.end(), [](float room) { return room >= 0.0f; }),
          "mesh {}: the room of a triangle is negative or not a number", i);
  check_corner_normals(*mesh.shape, i);
  check_vectors(mesh.positions, i, "position");
  check_vectors(mesh.normals, i, "normal");
  check_indices(mesh.shape->triangles, vertices, i, "triangle");
  check_indices(mesh.shape->edges, vertices, i, "edge");
}

void check_camera(const Camera& camera) {
  require(drawable(camera.eye) && drawable(camera.target) &&
              (camera.eye - camera.target).squaredNorm() > 0.0f,
          "camera: eye {} and target {} must be finite and apart", to_text(camera.eye),
          to_text(camera.target));
  require(camera.field_of_view >= 1.0f && camera.field_of_view <= 120.0f,
          "camera: the field of view is {}; allowed is 1..120 degrees", camera.field_of_view);
}

void check_legend(const Legend& legend) {
  require(legend.colours.size() >= 2, "legend: it has {} colours; allowed are two or more",
          legend.colours.size());
  for (const Legend::Tick& tick : legend.ticks) {
    require(tick.at >= 0.0f && tick.at <= 1.0f, "legend: the tick '{}' is at {}; allowed is 0..1",
            tick.text, tick.at);
  }
}

void check_light(const Light& light) {
  require(drawable(light.direction) && light.direction.squaredNorm() > 0.0f,
          "light: the direction is {}; it must be finite and not zero", to_text(light.direction));
  require(light.softness >= 0.0f && light.softness <= 0.2f,
          "light: the softness is {}; allowed is 0..0.2", light.softness);
}

}  // namespace

void check_frame(const Frame& frame) {
  check_camera(frame.camera);
  check_light(frame.light);
  if (frame.ground) {
    const float spacing = frame.ground->grid_spacing;
    require(spacing > 0.0f && std::isfinite(spacing),
            "ground: the grid spacing is {}; it must be positive", spacing);
  }
  for (std::size_t i = 0; i < frame.meshes.size(); ++i) check_mesh(frame.meshes[i], i);
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const Point& point = frame.points[i];
    require(drawable(point.position), "point {}: the position is {}; it must be finite", i,
            to_text(point.position));
    require(point.diameter > 0.0f && std::isfinite(point.diameter),
            "point {}: the diameter is {}; it must be positive", i, point.diameter);
  }
  for (std::size_t i = 0; i < frame.lines.size(); ++i) {
    const Line& line = frame.lines[i];
    require(drawable(line.from) && drawable(line.to),
            "line {}: it goes from {} to {}; both must be finite", i, to_text(line.from),
            to_text(line.to));
    require(line.width > 0.0f && std::isfinite(line.width),
            "line {}: the width is {}; it must be positive", i, line.width);
    require(!line.through || *line.through < frame.meshes.size(),
            "line {} shines through mesh {}, but there are {} meshes", i, line.through.value_or(0),
            frame.meshes.size());
  }
  for (const Label& label : frame.labels) {
    require(drawable(label.position), "label '{}': the position is {}; it must be finite",
            label.text, to_text(label.position));
  }
  if (frame.legend) check_legend(*frame.legend);
}

}  // namespace pneuma::render
