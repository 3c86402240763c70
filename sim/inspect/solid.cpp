#include "sim/inspect/solid.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "sim/collision/point_in_body.h"

namespace pneuma::sim {
namespace {

Vec3 to_vector(const base::Point& point) { return {point[0], point[1], point[2]}; }

Mat3 principal_axes(const ClosedSurface& surface) {
  Vec3 middle = Vec3::Zero();
  for (const auto& point : surface.points) middle += to_vector(point);
  middle /= static_cast<double>(surface.points.size());
  Mat3 spread = Mat3::Zero();
  for (const auto& point : surface.points) {
    const Vec3 way = to_vector(point) - middle;
    spread += way * way.transpose();
  }
  if (!spread.allFinite()) return Mat3::Identity();
  return Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors();
}

/// The part from `begin` to `end` of a segment, as shares of its length.
struct Part {
  double begin = 0.0;
  double end = 1.0;
};

/// The part of the segment from p to p + way that lies in a box along the axes of the coordinates.
std::optional<Part> clip_segment(const Vec3& p, const Vec3& way, const Bounds& box) {
  Part part;
  for (int k = 0; k < 3; ++k) {
    if (way[k] == 0.0) {
      if (p[k] < box.low[k] || p[k] > box.high[k]) return {};
      continue;
    }
    const double a = (box.low[k] - p[k]) / way[k], b = (box.high[k] - p[k]) / way[k];
    part.begin = std::max(part.begin, std::min(a, b));
    part.end = std::min(part.end, std::max(a, b));
  }
  if (!(part.begin <= part.end)) return {};
  return part;
}

}  // namespace

Solid::Solid(const SoftBody& body) : surface_(closed_surface(body)), body_(&body) {
  columns_.fill({body.mesh->topology, body.positions});
  axes_ = principal_axes(surface_);
}

Solid::Solid(const RigidBox& box)
    : surface_(closed_surface(box)),
      box_(OrientedBox{box.position, box.orientation.toRotationMatrix(), 0.5 * box.size}),
      axes_(box_->axes) {}

Bounds Solid::bounds_along(const Mat3& axes) const {
  Bounds bounds;
  for (const auto& point : surface_.points) bounds.include(axes.transpose() * to_vector(point));
  return bounds;
}

std::optional<DepthInside> Solid::find_depth(const Vec3& point) const {
  if (box_) {
    const auto exit = find_box_exit(*box_, point);
    if (!exit) return {};
    return DepthInside{exit->depth, -exit->normal};
  }
  const auto exit = find_surface_exit({body_->mesh->topology, body_->positions}, columns_, point);
  if (!exit) return {};
  return DepthInside{exit->depth, (point - exit->point).normalized()};
}

void Solid::sample_surface(const Solid& other, const std::function<void(const Vec3&)>& look) const {
  constexpr double max_parts = 16.0, parts_of_thickness = 8.0;
  const Bounds reach = other.bounds_along(other.axes());
  const double spacing = reach.size().minCoeff() / parts_of_thickness;
  const auto place = [&](int v) { return to_vector(surface_.points[at(v)]); };
  for (std::size_t v = 0; v < surface_.points.size(); ++v) look(place(static_cast<int>(v)));
  for (const auto& [a, b, c] : surface_.triangles) look((place(a) + place(b) + place(c)) / 3.0);
  for (const auto& [a, b] : surface_.edges) {
    const Vec3 way = place(b) - place(a);
    const auto part =
        clip_segment(other.axes().transpose() * place(a), other.axes().transpose() * way, reach);
    if (!part) continue;
    const double length = (part->end - part->begin) * way.norm();
    const int count = static_cast<int>(std::clamp(std::ceil(length / spacing), 1.0, max_parts));
    for (int i = 0; i < count; ++i) {
      look(place(a) + (part->begin + (part->end - part->begin) * (i + 0.5) / count) * way);
    }
  }
}

}  // namespace pneuma::sim
