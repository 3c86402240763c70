#include "render/geometry/drawn_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>

#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

DrawnSurface built(DrawnSurface surface, const std::vector<Mesh>& meshes) {
  Frame frame = empty_frame();
  frame.meshes = meshes;
  surface.build(frame, make_view(frame, 320, 240));
  return surface;
}

TEST(DrawnSurface, KeepsAShapeOnceAndWhileItLives) {
  std::vector<Mesh> meshes = {make_box({0, 0, 0}, {1, 1, 1}, {1, 0, 0})};
  meshes.push_back(meshes[0]);
  meshes.push_back(make_box({2, 0, 0}, {1, 1, 1}, {0, 1, 0}));
  DrawnSurface surface = built({}, meshes);
  EXPECT_EQ(surface.lit_meshes().size(), 3u);
  EXPECT_EQ(surface.shape_count(), 2u);
  // Out of the picture for a while, but alive.
  surface = built(std::move(surface), {});
  EXPECT_EQ(surface.shape_count(), 2u);
  meshes.clear();
  surface = built(std::move(surface), {});
  EXPECT_EQ(surface.shape_count(), 0u);
}

TEST(DrawnSurface, GivesAFlatMeshThreeVerticesATriangleAndASmoothOneItsOwn) {
  const Mesh box = make_box({0, 0, 0}, {1, 1, 1}, {1, 0, 0});
  const Mesh ball = make_ball({0, 0, 0}, 1, {1, 0, 0}, 6);
  const DrawnSurface surface = built({}, {box, ball});
  EXPECT_EQ(surface.lit_meshes()[0].count, 36u);
  EXPECT_EQ(surface.lit_meshes()[1].count, ball.positions.size());
  EXPECT_EQ(surface.triangles().size(), 12 + ball.shape->triangles.size());
  for (std::size_t i = 0; i < 36; ++i) {
    // A unit box about the origin: a face's normal is where its vertices are furthest out.
    EXPECT_NEAR(surface.vertices()[i].normal.dot(surface.vertices()[i].position), 0.5f, 1e-6f);
  }
}

TEST(DrawnSurface, KnowsHowFarFacetsAreFromTheNormal) {
  // At the corners of an octahedron along the axes each facet's normal is (1, 1, 1) / sqrt(3) but
  // for signs.
  Mesh octahedron;
  for (const float side : {1.0f, -1.0f}) {
    for (int axis = 0; axis < 3; ++axis) octahedron.positions.push_back(side * Vec3f::Unit(axis));
  }
  octahedron.normals = octahedron.positions;
  MeshShape shape;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t x = i & 1 ? 3 : 0, y = i & 2 ? 4 : 1, z = i & 4 ? 5 : 2;
    const bool is_mirrored = std::popcount(i) % 2 == 1;
    shape.triangles.push_back(is_mirrored ? Triangle{x, z, y} : Triangle{x, y, z});
  }
  shape.colours.assign(6, {1, 0, 0});
  octahedron.shape = std::make_shared<MeshShape>(std::move(shape));
  const DrawnSurface surface = built({}, {octahedron, make_box({3, 0, 0}, {1, 1, 1}, {1, 0, 0})});
  ASSERT_EQ(surface.vertices().size(), 6u + 36u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(surface.vertices()[i].flatness, 1.0f / 3.0f, 1e-6f);
  }
  for (std::size_t i = 6; i < 42; ++i) EXPECT_EQ(surface.vertices()[i].flatness, 1.0f);
}

TEST(DrawnSurface, LightsOnceWhatCornersOfAFaceShare) {
  Mesh box = make_box({0, 0, 0}, {1, 1, 1}, {1, 0, 0});
  auto shape = std::make_shared<MeshShape>(*box.shape);
  for (std::uint32_t face = 0; face < 6; ++face) {
    // Its two triangles: corners of the second that are also the first's have the first's normals.
    const Triangle &one = shape->triangles[2 * face], &other = shape->triangles[2 * face + 1];
    shape->corner_normals.push_back({6 * face, 6 * face + 1, 6 * face + 2});
    Triangle& numbers = shape->corner_normals.emplace_back();
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto same = std::ranges::find(one, other[i]) - one.begin();
      numbers[i] = 6 * face + (same < 3 ? static_cast<std::uint32_t>(same) : 3 + i);
    }
  }
  box.shape = shape;
  const DrawnSurface surface = built({}, {box});
  EXPECT_EQ(surface.lit_meshes()[0].count, 24u);
  EXPECT_EQ(surface.vertices().size(), 24u);
  ASSERT_EQ(surface.triangles().size(), 12u);
  for (const SurfaceVertex& vertex : surface.vertices()) {
    EXPECT_NEAR(vertex.normal.dot(vertex.position), 0.5f, 1e-6f);
  }
}

TEST(DrawnSurface, SharesTheNormalsOfCornersWithOneNumber) {
  const Vec3f centre = {0, 0, 2};
  Mesh ball = make_ball(centre, 1, {1, 0, 0}, 24);
  auto shape = std::make_shared<MeshShape>(*ball.shape);
  std::vector<std::uint32_t> first_corner(ball.positions.size(), ~0u);
  for (std::uint32_t t = 0; t < shape->triangles.size(); ++t) {
    auto& numbers = shape->corner_normals.emplace_back();
    for (std::uint32_t i = 0; i < 3; ++i) {
      std::uint32_t& first = first_corner[shape->triangles[t][i]];
      if (first == ~0u) first = 3 * t + i;
      numbers[i] = first;
    }
  }
  ball.normals.clear();
  const auto greatest_angle = [&] {
    float angle = 0.0f;
    const DrawnSurface surface = built({}, {ball});
    for (const SurfaceVertex& vertex : surface.vertices()) {
      const Vec3f outward = (vertex.position - centre).normalized();
      if (std::abs(outward.z()) > 0.95f) continue;  // at a pole each triangle has its own vertex
      angle = std::max(angle, std::acos(std::min(1.0f, vertex.normal.dot(outward))));
    }
    return angle;
  };
  EXPECT_GT(greatest_angle(), 0.08f);  // of flat triangles: from their middles to their corners
  ball.shape = shape;
  EXPECT_LT(greatest_angle(), 0.03f);  // triangles weigh by their areas
}

TEST(DrawnSurface, PutsWhatTheSunMayReachFirst) {
  Frame frame = empty_frame();
  frame.meshes = {make_box({0, 0, 0}, {1, 1, 1}, {1, 0, 0}),
                  make_ball({3, 0, 0}, 1, {1, 0, 0}, 12)};
  const View view = make_view(frame, 320, 240);
  DrawnSurface surface;
  surface.build(frame, view);
  const auto is_sunward = [&](const Triangle& triangle) {
    return std::ranges::any_of(triangle, [&](std::uint32_t vertex) {
      return surface.vertices()[vertex].normal.dot(view.to_light) > 0.0f;
    });
  };
  const std::size_t first_averted = surface.sunward_count();
  for (std::size_t i = 0; i < surface.triangles().size(); ++i) {
    EXPECT_EQ(is_sunward(surface.triangles()[i]), i < first_averted);
  }
  EXPECT_GT(first_averted, 0u);
  EXPECT_LT(first_averted, surface.triangles().size());
}

TEST(DrawnSurface, PutsTheNearestMeshFirst) {
  const Mesh far = make_box({0, 8, 0}, {1, 1, 1}, {1, 0, 0});
  const Mesh near = make_box({0, -4, 0}, {1, 1, 1}, {1, 0, 0});
  Frame frame = empty_frame();
  frame.camera = {{0, -20, 0}, Vec3f::Zero(), 40.0f};
  frame.meshes = {far, near};
  DrawnSurface surface;
  surface.build(frame, make_view(frame, 320, 240));
  const auto depth_of = [&](std::size_t triangle) {
    return surface.vertices()[surface.triangles()[triangle][0]].position.y();
  };
  EXPECT_LT(depth_of(0), 0.0f);
  EXPECT_GT(depth_of(surface.sunward_count() - 1), 0.0f);
  EXPECT_LT(depth_of(surface.sunward_count()), 0.0f);
  EXPECT_GT(depth_of(surface.triangles().size() - 1), 0.0f);
}

TEST(DrawnSurface, SeesTheFacesOfABoxThatAreTurnedToTheEye) {
  Frame frame = empty_frame();
  frame.camera = {{9, -20, 7}, Vec3f::Zero(), 40.0f};
  frame.meshes = {make_box({0, 0, 0}, {1, 1, 1}, {1, 0, 0})};
  DrawnSurface surface;
  surface.build(frame, make_view(frame, 320, 240));
  for (std::size_t i = 0; i < surface.positions().size(); ++i) {
    const Vec3f to_eye = frame.camera.eye - surface.positions()[i];
    EXPECT_EQ(surface.seen()[i] != 0, surface.normals()[i].dot(to_eye) > 0.0f) << i;
  }
}

TEST(DrawnSurface, ANewShapeInADeadOnesPlaceIsAnotherOne) {
  const auto box_frame = [](const Colour& colour) {
    Frame frame = empty_frame();
    frame.meshes = {make_box({0, 0, 0}, {2, 2, 2}, colour)};
    return frame;
  };
  Renderer renderer(small_picture());
  Image image;
  // Freed and allocated again without anything between: mostly at the same address.
  for (const Colour& colour : {Colour(0.9f, 0, 0), Colour(0, 0.9f, 0), Colour(0, 0, 0.9f)}) {
    const Frame frame = box_frame(colour);
    renderer.draw(frame, image);
    EXPECT_EQ(image.pixels, draw_once(frame, small_picture()).pixels);
  }
}

TEST(DrawnSurface, IsNotHiddenByTheGroundThatItIsPressedInto) {
  const auto lowest = [](const Mesh& mesh) {
    Frame frame = empty_frame();
    frame.ground = Ground{};
    frame.meshes = {mesh};
    DrawnSurface surface;
    surface.build(frame, make_view(frame, 320, 240));
    float low = 1e9f;
    for (const SurfaceVertex& vertex : surface.vertices()) low = std::min(low, vertex.position.z());
    return low;
  };
  const auto ball = [](float z) { return make_ball({0, 0, z}, 1, {1, 0, 0}, 6); };
  EXPECT_GT(lowest(ball(0.99f)), 0.0f);  // 1 cm in the ground
  EXPECT_NEAR(lowest(ball(1.5f)), 0.5f, 1e-6f);
  EXPECT_NEAR(lowest(ball(0.5f)), -0.5f, 1e-6f) << "what lies in the ground is shown to lie in it";
  EXPECT_GT(lowest(make_box({0, 0, 0.49f}, {1, 1, 1}, {1, 0, 0})), 0.0f);  // flat
}

TEST(DrawnSurface, StandsOnTheGroundAsWellInMillimetres) {
  constexpr float scale = 1e-3f;
  Frame frame = empty_frame();
  frame.ground = Ground{};
  frame.camera = {scale * Vec3f(0, -5, 1), Vec3f::Zero(), 40.0f};
  const auto lowest = [&](float z) {
    frame.meshes = {make_box({0, 0, scale * z}, Vec3f::Constant(scale), {1, 0, 0})};
    DrawnSurface surface;
    surface.build(frame, make_view(frame, 320, 240));
    float low = scale;
    for (const SurfaceVertex& vertex : surface.vertices()) low = std::min(low, vertex.position.z());
    return low / scale;
  };
  EXPECT_GT(lowest(0.5f), 0.0f);
  EXPECT_LT(lowest(0.5f), 0.01f) << "of its side, so much is cut off";
  EXPECT_GT(lowest(0.49f), 0.0f);
  EXPECT_NEAR(lowest(0.3f), -0.2f, 1e-6f) << "what lies in the ground is shown to lie in it";
}

}  // namespace
}  // namespace pneuma::render
