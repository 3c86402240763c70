// Rounded surfaces: as round as they say, within their room, and closed.
#include "render/geometry/rounding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "render/geometry/drawn_surface.h"
#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

float random_in(std::mt19937& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

TEST(RoundedPosition, OfAnArcLiesOnItsCircle) {
  // A chord over the angle t misses the circle by t^2 / 8 radii; at its middle the moved point
  // misses it by 5 t^4 / 192.
  for (const float angle : {0.2f, 0.4f, 0.8f}) {
    const Vec3f start = {1, 0, 0};
    const Vec3f end = {std::cos(angle), std::sin(angle), 0};
    const std::vector<Vec3f> corners = {start, end, {0, 0, 9}};
    const std::vector<float> share = {1, 1, 1};
    for (float w = 0.1f; w < 0.95f; w += 0.1f) {
      const SurfacePoint point = {{0, 1, 2}, {1 - w, w, 0}};
      const Vec3f position = rounded_position(corners, corners, share, point);
      EXPECT_NEAR(position.norm(), 1.0f, 6.0f * std::pow(angle, 4.0f) / 192.0f) << angle;
    }
  }
}

TEST(BulgeShares, KeepEveryPointWithinTheRoomOfItsTriangle) {
  std::mt19937 random(3);
  const Mesh ball = make_ball({0, 0, 0}, 1.0f, {1, 0, 0}, 7);
  const std::vector<Triangle>& triangles = ball.shape->triangles;
  std::vector<float> room;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    room.push_back(t % 5 == 0 ? 0.0f : random_in(random, 0.0f, 0.1f));
  }
  const std::vector<float> share = bulge_shares(triangles, ball.positions, ball.normals, room);
  float moved_most = 0.0f;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 50; ++i) {
      const float a = random_in(random, 0, 1);
      const float b = random_in(random, 0, 1 - a);
      const SurfacePoint point = {triangles[t], {1 - a - b, a, b}};
      Vec3f flat = Vec3f::Zero();
      for (std::size_t c = 0; c < 3; ++c) {
        flat += point.weights[c] * ball.positions[triangles[t][c]];
      }
      const Vec3f position = rounded_position(ball.positions, ball.normals, share, point);
      moved_most = std::max(moved_most, (position - flat).norm());
      EXPECT_LE((position - flat).norm(), room[t] + 1e-6f);
    }
  }
  EXPECT_GT(moved_most, 0.0f);
}

/// A triangle along a cone, whose normal at the rim leans outwards as that of the base has a part
/// in it. As much room as there may be.
TEST(BulgeShares, LeaveLongTrianglesNearlyStraight) {
  const std::vector<Vec3f> positions = {
      {0.0f, 0.0f, 4.0f}, {1.0f, -0.25f, 0.0f}, {1.0f, 0.25f, 0.0f}};
  const std::vector<Vec3f> normals = {Vec3f::UnitZ(), Vec3f(1.0f, -0.25f, -0.4f).normalized(),
                                      Vec3f(1.0f, 0.25f, -0.4f).normalized()};
  const Triangle triangle = {0, 1, 2};
  const std::vector<Triangle> triangles = {triangle};
  const std::vector<float> room = {100.0f};
  EXPECT_GT(bulge_bound(triangle, positions, normals), 0.5f);
  const std::vector<float> share = bulge_shares(triangles, positions, normals, room);
  const SurfacePoint middle = {triangle, {0.5f, 0.25f, 0.25f}};
  const Vec3f flat = 0.5f * positions[0] + 0.25f * (positions[1] + positions[2]);
  EXPECT_LT((rounded_position(positions, normals, share, middle) - flat).norm(), 0.4f * 0.5f);
}

TEST(Refine, LeavesAClosedSurfaceClosed) {
  const Mesh ring = make_ring({0, 0, 0}, 2.0f, 0.7f, {1, 0, 0}, {1, 0, 0});
  std::mt19937 random(5);
  const Refinement refined = refine(ring.shape->triangles, ring.positions.size(), 3,
                                    [&](const std::vector<SurfacePoint>&, std::uint32_t,
                                        std::uint32_t) { return random() % 3 != 0; });
  EXPECT_GT(refined.triangles.size(), 3 * ring.shape->triangles.size());
  const auto count_open = [](const std::vector<Triangle>& triangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const Triangle& t : triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
      }
    }
    return std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second != 0; });
  };
  EXPECT_EQ(count_open(ring.shape->triangles), 0);
  EXPECT_EQ(count_open(refined.triangles), 0);
}

TEST(RoundedBall, HasTheOutlineOfACircle) {
  const auto outline_error = [](bool rounded) {
    Frame frame = empty_frame();
    const Image empty = draw_once(frame, small_picture(1));
    frame.meshes = {make_ball({0, 0, 0}, 2.0f, {0.1f, 0.1f, 0.1f}, 8)};
    if (rounded) frame.meshes[0].room.assign(frame.meshes[0].shape->triangles.size(), 1.0f);
    const Image image = draw_once(frame, small_picture(1));
    // A ball of radius r at distance d fills a cone of half angle asin(r / d).
    const double radius = std::tan(std::asin(0.2)) / std::tan(20.0 * 3.14159265 / 180.0) * 120.0;
    double nearest = radius;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        if (pixel_at(image, x, y) != pixel_at(empty, x, y)) continue;
        nearest = std::min(nearest, std::hypot(x + 0.5 - 160.0, y + 0.5 - 120.0));
      }
    }
    return radius - nearest;
  };
  // Sixteen sides cut off up to 1 - cos(pi / 16) = 1.9 % of 67 pixels, and eight rings 7.6 % of
  // that in the other direction; rounded, a pixel is left for the picture's own grid.
  EXPECT_GT(outline_error(false), 1.3);
  EXPECT_LT(outline_error(true), 1.2);
}

}  // namespace
}  // namespace pneuma::render
