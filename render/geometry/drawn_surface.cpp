#include "render/geometry/drawn_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "render/geometry/rounding.h"

namespace pneuma::render {
namespace {

constexpr float visible_error = 0.5f;      // pixels between a rounded outline and its chords
constexpr int most_levels = 3;             // each time quarters that distance
constexpr float visible_in_shadow = 1.4f;  // likewise; shadows have soft edges

/// Pixels of the picture to a metre, where the mesh is nearest to the eye.
float pixels_per_metre(const Mesh& mesh, const View& view) {
  float nearest = view.far;
  for (const Vec3f& position : mesh.positions) {
    nearest = std::min(nearest, depth(view, position));
  }
  const float distance = std::max(nearest, view.near);
  return 0.5f * static_cast<float>(view.height) * view.projection(1, 1) / distance;
}

/// Whether the surface between two points with these normals turns away, or does so next to them,
/// for who looks against `to_viewer`: there its bends are seen, and elsewhere its shading alone.
bool at_outline(const Vec3f& a, const Vec3f& b, const Vec3f& to_viewer) {
  const float first = a.dot(to_viewer);
  const float second = b.dot(to_viewer);
  const float bend = 0.5f * (a - b).norm() + 0.03f;
  return first * second <= 0.0f || std::min(std::abs(first), std::abs(second)) < bend;
}

/// Whether the edge between two points of a rounded surface is seen to be straight, where a metre
/// is so many pixels.
bool bend_is_seen(const SurfaceVertex& a, const SurfaceVertex& b, float pixels, const View& view) {
  // An arc's height over its chord, from the angle between its ends' normals.
  const float height =
      0.125f * pixels * (a.normal - b.normal).norm() * (a.position - b.position).norm();
  if (height < visible_error) return false;
  const Vec3f to_eye = (view.eye - 0.5f * (a.position + b.position)).normalized();
  return at_outline(a.normal, b.normal, to_eye) ||
         (height > visible_in_shadow && at_outline(a.normal, b.normal, view.to_light));
}

/// Where the ground may not hide a body, for a camera at some distance from its target: of scenes
/// of millimetres, which are seen from as near, less than of those of metres.
class GroundLimits {
 public:
  explicit GroundLimits(const View& view) {
    const float distance = (view.target - view.eye).norm();
    most_sunk_ = std::min(most_sunk_, 0.03f * distance);
    just_above_ = std::min(just_above_, 4e-4f * distance);
  }

  /// No point above the ground comes nearer to it than half its height, and none that is pressed
  /// into it is hidden by it.
  Vec3f kept_above(Vec3f position, float flat_height) const {
    if (flat_height <= -most_sunk_) return position;
    position.z() = std::max({position.z(), 0.5f * flat_height, just_above_});
    return position;
  }

 private:
  // m. A soft body that rests may be so far below the ground, which would show through its skin.
  float most_sunk_ = 0.03f;
  // m: by less than a pixel, and by what the depths of pixels tell apart.
  float just_above_ = 0.002f;
};

float height_of(const SurfacePoint& point, std::span<const Vec3f> positions) {
  float height = 0.0f;
  for (std::size_t i = 0; i < 3; ++i) height += point.weights[i] * positions[point.corners[i]].z();
  return height;
}

template <typename Value>
Value mixed(const SurfacePoint& point, const std::vector<Value>& of) {
  return point.weights[0] * of[point.corners[0]] + point.weights[1] * of[point.corners[1]] +
         point.weights[2] * of[point.corners[2]];
}

/// Per vertex, as in SurfaceVertex.
std::vector<float> flatness_of(const Mesh& mesh) {
  std::vector<float> flatness(mesh.positions.size(), 1.0f);
  for (const Triangle& t : mesh.shape->triangles) {
    const Vec3f& a = mesh.positions[t[0]];
    const Vec3f across = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
    const Vec3f facet = across.stableNormalized();
    if (facet.isZero(0.0f)) continue;  // it has no area
    for (const std::uint32_t v : t) {
      const float cosine = std::max(mesh.normals[v].dot(facet), 0.0f);
      flatness[v] = std::min(flatness[v], cosine * cosine);
    }
  }
  return flatness;
}

/// Linear colours of a mesh that has its own.
std::vector<Vec3f> own_colours(const Mesh& mesh) {
  std::vector<Vec3f> colours;
  for (const Colour& colour : mesh.colours) colours.push_back(to_linear(colour));
  return colours;
}

Eigen::Vector4f material(const Vec3f& colour, float roughness) {
  return {colour.x(), colour.y(), colour.z(), roughness};
}

/// m before the eye.
float middle_depth(const Mesh& mesh, const View& view) {
  Vec3f sum = Vec3f::Zero();
  for (const Vec3f& position : mesh.positions) sum += position;
  return depth(view, sum / static_cast<float>(mesh.positions.size()));
}

}  // namespace

void DrawnSurface::build(const Frame& frame, const View& view) {
  std::erase_if(shapes_, [](const auto& entry) { return entry.first.expired(); });
  lit_meshes_.clear();
  positions_.clear();
  normals_.clear();
  points_.clear();
  vertices_.clear();
  triangles_.clear();
  places_.clear();
  meshes_.clear();
  for (const Mesh& mesh : frame.meshes) {
    const std::size_t first = triangles_.size();
    mesh.normals.empty() ? add_flat(mesh, frame, view) : add_smooth(mesh, frame, view);
    meshes_.push_back({middle_depth(mesh, view), {first, triangles_.size()}, meshes_.size()});
  }
  order_triangles(view);
  find_seen(view.eye);
}

void DrawnSurface::find_seen(const Vec3f& eye) {
  seen_.assign(positions_.size(), 0);
  for (const Triangle& t : triangles_) {
    const Vec3f& a = vertices_[t[0]].position;
    const Vec3f normal = (vertices_[t[1]].position - a).cross(vertices_[t[2]].position - a);
    if (normal.dot(eye - a) <= 0.0f) continue;
    for (const std::uint32_t vertex : t) {
      for (const std::uint32_t corner : points_[vertex].corners) seen_[corner] = 1;
    }
  }
}

void DrawnSurface::order_triangles(const View& view) {
  const auto is_sunward = [&](const Triangle& triangle) {
    return std::any_of(triangle.begin(), triangle.end(), [&](std::uint32_t vertex) {
      return vertices_[vertex].normal.dot(view.to_light) > 0.0f;
    });
  };
  std::ranges::stable_sort(meshes_, {}, &MeshTriangles::depth);
  sunward_.clear();
  averted_.clear();
  parts_.resize(meshes_.size());
  for (const MeshTriangles& mesh : meshes_) {
    auto& [sunward, averted] = parts_[mesh.mesh];
    sunward.first = sunward_.size();
    averted.first = averted_.size();
    for (std::size_t i = mesh.range.first; i < mesh.range.end; ++i) {
      (is_sunward(triangles_[i]) ? sunward_ : averted_).push_back(triangles_[i]);
    }
    sunward.end = sunward_.size();
    averted.end = averted_.size();
  }
  sunward_count_ = sunward_.size();
  for (auto& [sunward, averted] : parts_) {
    averted.first += sunward_count_;
    averted.end += sunward_count_;
  }
  std::ranges::copy(averted_, std::ranges::copy(sunward_, triangles_.begin()).out);
}

void DrawnSurface::add_lit_mesh(const Mesh& mesh, std::size_t count) {
  lit_meshes_.push_back({mesh.shape, !mesh.normals.empty(), positions_.size(), count});
}

void DrawnSurface::append(const Refinement& refinement) {
  const auto first_vertex = static_cast<std::uint32_t>(points_.size());
  const auto first_lit = static_cast<std::uint32_t>(lit_meshes_.back().first);
  for (SurfacePoint point : refinement.points) {
    for (std::uint32_t& corner : point.corners) corner += first_lit;
    points_.push_back(point);
  }
  for (const Triangle& t : refinement.triangles) {
    triangles_.push_back({t[0] + first_vertex, t[1] + first_vertex, t[2] + first_vertex});
  }
}

void DrawnSurface::add_smooth(const Mesh& mesh, const Frame& frame, const View& view) {
  add_lit_mesh(mesh, mesh.positions.size());
  positions_.insert(positions_.end(), mesh.positions.begin(), mesh.positions.end());
  normals_.insert(normals_.end(), mesh.normals.begin(), mesh.normals.end());
  const std::vector<Triangle>& triangles = mesh.shape->triangles;
  std::vector<float> share(mesh.positions.size(), 0.0f);
  float pixels = 0.0f;  // to a metre
  if (!mesh.room.empty()) {
    share = bulge_shares(triangles, mesh.positions, mesh.normals, mesh.room);
    pixels = pixels_per_metre(mesh, view);
  }
  std::vector<SurfaceVertex> vertices;  // of the points so far
  const GroundLimits limits(view);
  const std::vector<float> flatness = flatness_of(mesh);
  const std::vector<Vec3f> own = own_colours(mesh);
  const std::vector<Vec3f>& colours = own.empty() ? shape_of(mesh.shape).colours : own;
  const auto add_vertices = [&](const std::vector<SurfacePoint>& points) {
    for (std::size_t i = vertices.size(); i < points.size(); ++i) {
      Vec3f position = rounded_position(mesh.positions, mesh.normals, share, points[i]);
      if (frame.ground) {
        position = limits.kept_above(position, height_of(points[i], mesh.positions));
      }
      vertices.push_back({position, mixed(points[i], mesh.normals).normalized(),
                          mixed(points[i], flatness),
                          material(mixed(points[i], colours), mesh.roughness)});
    }
  };
  const auto needs_halving = [&](const std::vector<SurfacePoint>& points, std::uint32_t a,
                                 std::uint32_t b) {
    add_vertices(points);
    return bend_is_seen(vertices[a], vertices[b], pixels, view);
  };
  const Refinement refinement =
      refine(triangles, mesh.positions.size(), pixels > 0.0f ? most_levels : 0, needs_halving);
  add_vertices(refinement.points);
  append(refinement);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    places_.push_back(static_cast<std::uint32_t>(places_.size()));
  }
  vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
}

/// Where triangles share a corner's normal, the larger bend it more.
void DrawnSurface::add_corner_normals(const Mesh& mesh, const Shape& shape) {
  const std::size_t first = normals_.size();
  normals_.resize(first + shape.sources.size(), Vec3f::Zero());
  for (const Triangle& t : shape.corners) {
    const auto position = [&](std::size_t i) { return mesh.positions[shape.sources[t[i]]]; };
    const Vec3f a = position(0), across = (position(1) - a).cross(position(2) - a);
    for (const std::uint32_t corner : t) normals_[first + corner] += across;
  }
  for (std::size_t i = first; i < normals_.size(); ++i) normals_[i].stableNormalize();
}

void DrawnSurface::add_flat(const Mesh& mesh, const Frame& frame, const View& view) {
  Shape& shape = shape_of(mesh.shape);
  if (shape.corners.empty()) share_corners(*mesh.shape, shape);
  const std::vector<Vec3f> own = own_colours(mesh);
  const std::vector<Vec3f>& colours = own.empty() ? shape.colours : own;
  add_lit_mesh(mesh, shape.sources.size());
  add_corner_normals(mesh, shape);
  Refinement whole;
  whole.triangles = shape.corners;
  const GroundLimits limits(view);
  std::vector<std::uint32_t> first_at(mesh.positions.size(), ~0u);
  for (std::uint32_t i = 0; i < shape.sources.size(); ++i) {
    const std::uint32_t v = shape.sources[i];
    const Vec3f& position = mesh.positions[v];
    whole.points.push_back({{i, i, i}, {1.0f, 0.0f, 0.0f}});
    positions_.push_back(position);
    if (first_at[v] == ~0u) first_at[v] = static_cast<std::uint32_t>(vertices_.size());
    places_.push_back(first_at[v]);
    vertices_.push_back({frame.ground ? limits.kept_above(position, position.z()) : position,
                         normals_[positions_.size() - 1], 1.0f,
                         material(colours[v], mesh.roughness)});
  }
  append(whole);
}

void DrawnSurface::spread(const std::vector<IndirectLight>& light,
                          std::vector<IndirectLight>& drawn) const {
  drawn.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto& [corners, weights] = points_[i];
    IndirectLight sum = {Vec3f::Zero(), Eigen::Vector2f::Zero(), light[corners[0]].near_boxes};
    for (std::size_t c = 0; c < 3; ++c) {
      sum.bounced += weights[c] * light[corners[c]].bounced;
      sum.open_to += weights[c] * light[corners[c]].open_to;
    }
    drawn[i] = sum;
  }
}

void DrawnSurface::share_corners(const MeshShape& shape, Shape& made) {
  std::vector<std::uint32_t> lit(3 * shape.triangles.size(), ~0u);  // by the normal's number
  for (std::uint32_t t = 0; t < shape.triangles.size(); ++t) {
    Triangle& corners = made.corners.emplace_back();
    for (std::uint32_t i = 0; i < 3; ++i) {
      const bool own = shape.corner_normals.empty();
      std::uint32_t& vertex = lit[own ? 3 * t + i : shape.corner_normals[t][i]];
      if (vertex == ~0u) {
        vertex = static_cast<std::uint32_t>(made.sources.size());
        made.sources.push_back(shape.triangles[t][i]);
      }
      corners[i] = vertex;
    }
  }
}

DrawnSurface::Shape& DrawnSurface::shape_of(const std::shared_ptr<const MeshShape>& shape) {
  const auto known = shapes_.find(shape);
  if (known != shapes_.end()) return known->second;
  Shape& made = shapes_[shape];
  for (const Colour& colour : shape->colours) made.colours.push_back(to_linear(colour));
  return made;
}

}  // namespace pneuma::render
