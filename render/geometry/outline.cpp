#include "render/geometry/outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

namespace pneuma::render {
namespace {

constexpr char front = 1, back = 2, flat = 4;
constexpr char may_end = front | back;

constexpr float alike = 0.99f;  // cosine between normals of faces that look alike: 8 degrees

}  // namespace

void Outline::mark_places(const DrawnSurface& surface, const Vec3f& eye) {
  const std::vector<SurfaceVertex>& vertices = surface.vertices();
  const std::vector<Triangle>& triangles = surface.triangles();
  const std::vector<std::uint32_t>& places = surface.places();
  faces_eye_.resize(triangles.size());
  seen_.assign(vertices.size(), 0);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    const Vec3f& a = vertices[t[0]].position;
    const Vec3f normal = (vertices[t[1]].position - a).cross(vertices[t[2]].position - a);
    const bool faces = normal.dot(eye - a) > 0.0f;
    faces_eye_[i] = faces;
    // A flat mesh has vertices of its own for each triangle.
    const bool apart = places[t[0]] != t[0] || places[t[1]] != t[1] || places[t[2]] != t[2];
    const char kind = static_cast<char>((faces ? front : back) | (apart ? flat : 0));
    for (const std::uint32_t corner : t) seen_[places[corner]] |= kind;
  }
}

void Outline::collect_sides(const DrawnSurface& surface) {
  const std::vector<std::uint32_t>& places = surface.places();
  sides_.clear();
  for (std::uint32_t i = 0; i < surface.triangles().size(); ++i) {
    if (!faces_eye_[i]) continue;
    const Triangle& t = surface.triangles()[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t from = t[c], to = t[(c + 1) % 3];
      const char both = seen_[places[from]] & seen_[places[to]];
      if ((both & may_end) != may_end && (both & flat) == 0) continue;
      const auto [low, high] = std::minmax(places[from], places[to]);
      sides_.push_back({low, high, {from, to, i}});
    }
  }
}

void Outline::keep_outlines(const DrawnSurface& surface, const View& view) {
  std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.edge.from) < std::tie(b.low, b.high, b.edge.from);
  });
  const std::vector<SurfaceVertex>& vertices = surface.vertices();
  edges_.clear();
  for (std::size_t i = 0; i < sides_.size();) {
    const Side& side = sides_[i];
    std::size_t next = i + 1;
    while (next < sides_.size() && sides_[next].low == side.low && sides_[next].high == side.high) {
      ++next;
    }
    const bool ends = next == i + 1;
    // Where the sides of an edge share a normal, at both ends, it is smooth.
    const auto differ = [&](std::uint32_t one, std::uint32_t other) {
      return vertices[one].normal.dot(vertices[other].normal) < alike;
    };
    const bool folds = !ends && (differ(side.edge.from, sides_[i + 1].edge.to) ||
                                 differ(side.edge.to, sides_[i + 1].edge.from));
    const auto is_ahead = [&](std::uint32_t vertex) {
      return depth(view, vertices[vertex].position) > view.near;
    };
    if ((ends || folds) && is_ahead(side.edge.from) && is_ahead(side.edge.to)) {
      edges_.push_back(side.edge);
    }
    i = next;
  }
}

void Outline::find(const DrawnSurface& surface, const View& view) {
  mark_places(surface, view.eye);
  collect_sides(surface);
  keep_outlines(surface, view);
}

}  // namespace pneuma::render
