#include "render/light/box_contacts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace pneuma::render {
namespace {

constexpr float reach_of_side = 1.0f / 6.0f;  // of the shorter of two boxes' shortest sides
constexpr float tolerance = 1e-3f;            // of a box's size

float reach_between(const OrientedBox& a, const OrientedBox& b) {
  return reach_of_side * 2.0f * std::min(a.half.minCoeff(), b.half.minCoeff());
}

bool are_perpendicular(const Vec3f& a, const Vec3f& b) {
  return std::abs(a.dot(b)) < tolerance * a.norm() * b.norm();
}

/// Whether all corners are where those of the box are.
bool fits(const OrientedBox& box, const std::vector<Vec3f>& corners) {
  return std::ranges::all_of(corners, [&](const Vec3f& corner) {
    const Vec3f away = (box.axes * (corner - box.centre)).cwiseAbs() - box.half;
    return away.cwiseAbs().maxCoeff() < tolerance * box.radius();
  });
}

/// With these edges from its first corner.
OrientedBox box_on(const Vec3f& corner, const std::array<Vec3f, 3>& edges) {
  OrientedBox box;
  box.centre = corner + 0.5f * (edges[0] + edges[1] + edges[2]);
  for (int i = 0; i < 3; ++i) {
    const Vec3f& edge = edges[static_cast<std::size_t>(i)];
    box.half[i] = 0.5f * edge.norm();
    box.axes.row(i) = edge.normalized().transpose();
  }
  return box;
}

/// What a box takes of the light of a face, on average over points of it.
float taken_of_face(const OrientedBox& box, const Vec3f& middle, const Vec3f& u, const Vec3f& v,
                    float reach) {
  constexpr int steps = 4;
  if (box.distance_to(middle) > (u + v).norm() + reach) return 0.0f;
  float sum = 0.0f;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      const float along_u = 2.0f * static_cast<float>(i) / steps - 1.0f;
      const float along_v = 2.0f * static_cast<float>(j) / steps - 1.0f;
      const float distance = box.distance_to(middle + along_u * u + along_v * v);
      sum += std::clamp(0.5f - 0.5f * distance / reach, 0.0f, 1.0f);
    }
  }
  return sum / ((steps + 1) * (steps + 1));
}

/// Along each axis in units in which the box is a cube; along the one towards the face in reaches.
Eigen::Vector4f in_box(const OrientedBox& box, const Vec3f& point, const Vec3f& normal,
                       float reach) {
  int towards = 0;
  (box.axes * normal).cwiseAbs().maxCoeff(&towards);
  const float half = box.half[towards] / reach;
  const Vec3f at =
      half * (box.axes * (point + reach * normal - box.centre)).cwiseQuotient(box.half);
  return {at.x(), at.y(), at.z(), half};
}

}  // namespace

float OrientedBox::distance_to(const Vec3f& point) const {
  const Vec3f away = (axes * (point - centre)).cwiseAbs() - half;
  return away.cwiseMax(0.0f).norm() + std::min(away.maxCoeff(), 0.0f);
}

std::optional<OrientedBox> box_of(const Mesh& mesh) {
  const std::vector<Vec3f>& x = mesh.positions;
  if (!mesh.normals.empty() || x.size() != 8 || mesh.shape->triangles.size() != 12) return {};
  for (std::size_t i = 1; i < 8; ++i) {
    for (std::size_t j = i + 1; j < 8; ++j) {
      if (!are_perpendicular(x[i] - x[0], x[j] - x[0])) continue;
      for (std::size_t k = j + 1; k < 8; ++k) {
        const std::array<Vec3f, 3> edges = {x[i] - x[0], x[j] - x[0], x[k] - x[0]};
        if (!are_perpendicular(edges[0], edges[2]) || !are_perpendicular(edges[1], edges[2])) {
          continue;
        }
        const OrientedBox box = box_on(x[0], edges);
        if (box.half.minCoeff() > 0.0f && fits(box, x)) return box;
      }
    }
  }
  return {};
}

bool BoxContacts::find(const std::vector<Mesh>& meshes, const DrawnSurface& surface,
                       const Vec3f& eye, std::vector<IndirectLight>& light) {
  take_boxes(meshes);
  find_neighbours();
  bool is_any = false;
  for (const Body& body : bodies_) {
    if (body.near.empty()) continue;
    for (int side = 0; side < 6; ++side) {
      const int axis = side / 2;
      const Vec3f normal = (side % 2 == 0 ? 1.0f : -1.0f) * body.box.axes.row(axis).transpose();
      const Vec3f middle = body.box.centre + body.box.half[axis] * normal;
      if (normal.dot(eye - middle) <= 0.0f) continue;
      is_any |= darken_face(body, normal, surface.lit_meshes()[body.mesh], surface, light);
    }
  }
  return is_any;
}

void BoxContacts::take_boxes(const std::vector<Mesh>& meshes) {
  bodies_.clear();
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (const auto box = box_of(meshes[i])) bodies_.push_back({*box, i, {}});
  }
}

/// Sweep and prune along x, with the balls around the boxes.
void BoxContacts::find_neighbours() {
  const auto low = [](const Body& body) { return body.box.centre.x() - body.box.radius(); };
  std::ranges::sort(bodies_, {}, low);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const OrientedBox& box = bodies_[i].box;
    const float room = box.radius() + 2.0f * reach_of_side * box.half.minCoeff() * 2.0f;
    for (std::size_t j = i + 1; j < bodies_.size(); ++j) {
      if (low(bodies_[j]) > box.centre.x() + room) break;
      const OrientedBox& other = bodies_[j].box;
      if ((other.centre - box.centre).norm() > room + other.radius()) continue;
      bodies_[i].near.push_back(j);
      bodies_[j].near.push_back(i);
    }
  }
}

/// Whether anything is near it.
bool BoxContacts::darken_face(const Body& body, const Vec3f& normal, const LitMesh& lit,
                              const DrawnSurface& surface, std::vector<IndirectLight>& light) {
  const OrientedBox& box = body.box;
  int axis = 0;
  (box.axes * normal).cwiseAbs().maxCoeff(&axis);
  const auto side = [&](int i) -> Vec3f { return box.half[i] * box.axes.row(i).transpose(); };
  const Vec3f u = side((axis + 1) % 3), v = side((axis + 2) % 3);
  near_.clear();
  for (const std::size_t i : body.near) {
    const OrientedBox& other = bodies_[i].box;
    const float reach = reach_between(box, other);
    const Vec3f raised = box.centre + (box.half[axis] + reach) * normal;
    const float taken = taken_of_face(other, raised, u, v, reach);
    if (taken > 0.0f) near_.push_back({taken, i});
  }
  std::ranges::sort(near_, std::ranges::greater{}, &Near::taken);
  for (std::size_t i = lit.first; i < lit.first + lit.count; ++i) {
    if (surface.normals()[i].dot(normal) < 0.99f) continue;
    for (std::size_t k = 0; k < std::min(near_.size(), light[i].near_boxes.size()); ++k) {
      const OrientedBox& other = bodies_[near_[k].body].box;
      light[i].near_boxes[k] =
          in_box(other, surface.positions()[i], normal, reach_between(box, other));
    }
  }
  return !near_.empty();
}

}  // namespace pneuma::render
