#include "tests/render/shapes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace pneuma::render {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

void add_quad(MeshShape& shape, std::uint32_t a, std::uint32_t b, std::uint32_t c,
              std::uint32_t d) {
  shape.triangles.push_back({a, b, c});
  shape.triangles.push_back({a, c, d});
}

struct BoxShape {
  MeshShape shape;
  std::vector<Vec3f> corners;  // of a box of size 1 about the origin
};

BoxShape unit_box() {
  BoxShape box;
  for (std::uint32_t i = 0; i < 8; ++i) {
    box.corners.emplace_back((i & 1) != 0 ? 0.5f : -0.5f, (i & 2) != 0 ? 0.5f : -0.5f,
                             (i & 4) != 0 ? 0.5f : -0.5f);
    for (const std::uint32_t bit : {1u, 2u, 4u}) {
      if ((i & bit) == 0) box.shape.edges.push_back({i, i | bit});
    }
  }
  add_quad(box.shape, 0, 4, 6, 2);
  add_quad(box.shape, 1, 3, 7, 5);
  add_quad(box.shape, 0, 1, 5, 4);
  add_quad(box.shape, 2, 6, 7, 3);
  add_quad(box.shape, 0, 2, 3, 1);
  add_quad(box.shape, 4, 5, 7, 6);
  return box;
}

}  // namespace

Mesh make_ball(const Vec3f& centre, float radius, const Colour& colour, int rings) {
  auto shape = std::make_shared<MeshShape>();
  Mesh mesh;
  const int slices = 2 * rings;
  const auto index = [slices](int ring, int slice) {
    return static_cast<std::uint32_t>(ring * slices + slice % slices);
  };
  for (int ring = 0; ring <= rings; ++ring) {
    const float polar = pi * static_cast<float>(ring) / static_cast<float>(rings);
    for (int slice = 0; slice < slices; ++slice) {
      const float around = 2.0f * pi * static_cast<float>(slice) / static_cast<float>(slices);
      const Vec3f normal = {std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                            std::cos(polar)};
      mesh.positions.push_back(centre + radius * normal);
      mesh.normals.push_back(normal);
      shape->colours.push_back(colour);
      if (ring == rings) continue;
      add_quad(*shape, index(ring, slice), index(ring + 1, slice), index(ring + 1, slice + 1),
               index(ring, slice + 1));
      shape->edges.push_back({index(ring, slice), index(ring + 1, slice)});
      shape->edges.push_back({index(ring, slice), index(ring, slice + 1)});
    }
  }
  mesh.shape = shape;
  return mesh;
}

Mesh make_ring(const Vec3f& centre, float radius, float thickness, const Colour& top,
               const Colour& foot, int around_count, int tube_count) {
  auto shape = std::make_shared<MeshShape>();
  Mesh mesh;
  const auto index = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % around_count) * tube_count + j % tube_count);
  };
  for (int i = 0; i < around_count; ++i) {
    const float around = 2.0f * pi * static_cast<float>(i) / static_cast<float>(around_count);
    const Vec3f outward = {std::cos(around), std::sin(around), 0.0f};
    for (int j = 0; j < tube_count; ++j) {
      const float tube = 2.0f * pi * static_cast<float>(j) / static_cast<float>(tube_count);
      const Vec3f normal = outward * std::cos(tube) + Vec3f::UnitZ() * std::sin(tube);
      mesh.positions.push_back(centre + radius * outward + thickness * normal);
      mesh.normals.push_back(normal);
      const float height = 0.5f + 0.5f * std::sin(tube);
      shape->colours.push_back(foot + height * (top - foot));
      add_quad(*shape, index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
      shape->edges.push_back({index(i, j), index(i + 1, j)});
      shape->edges.push_back({index(i, j), index(i, j + 1)});
    }
  }
  mesh.shape = shape;
  return mesh;
}

Mesh make_box(const Vec3f& centre, const Vec3f& size, const Colour& colour) {
  BoxShape box = unit_box();
  Mesh mesh;
  for (const Vec3f& corner : box.corners) {
    mesh.positions.push_back(centre + size.cwiseProduct(corner));
  }
  box.shape.colours.assign(8, colour);
  mesh.shape = std::make_shared<MeshShape>(std::move(box.shape));
  return mesh;
}

Mesh make_painted_box(const Vec3f& centre, float size, float turn) {
  BoxShape box = unit_box();
  const Eigen::Matrix3f rotation =
      Eigen::AngleAxisf(turn, Vec3f(0.3f, 0.5f, 0.8f).normalized()).toRotationMatrix();
  Mesh mesh;
  for (const Vec3f& corner : box.corners) {
    mesh.positions.push_back(centre + size * (rotation * corner));
    box.shape.colours.push_back(corner.x() > 0.0f ? Colour(0.85f, 0.2f, 0.15f)
                                                  : Colour(0.2f, 0.35f, 0.8f));
  }
  mesh.shape = std::make_shared<MeshShape>(std::move(box.shape));
  return mesh;
}

}  // namespace pneuma::render
