#include "render/frame/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/render/probe.h"

namespace pneuma::render {
namespace {

Eigen::Vector4f clip(const Camera& camera, float aspect, const Vec3f& point) {
  return projection_matrix(camera.field_of_view, aspect, 0.01f, 1000.0f) * view_matrix(camera) *
         point.homogeneous();
}

TEST(ViewMatrix, PutsTheTargetStraightAheadAndKeepsLengths) {
  const Camera camera = {{3.0f, -4.0f, 2.0f}, {1.0f, 1.0f, 0.5f}, 40.0f};
  const Mat4f view = view_matrix(camera);
  const Vec3f target = (view * camera.target.homogeneous()).head<3>();
  const float distance = (camera.target - camera.eye).norm();
  // Single precision on numbers of size 10.
  EXPECT_TRUE(target.isApprox(Vec3f(0.0f, 0.0f, -distance), 1e-5f)) << target.transpose();
  EXPECT_NEAR(view.topLeftCorner(3, 3).determinant(), 1.0f, 1e-5f);
  // The world's up is up in the picture, without a component to the side.
  const Vec3f up = view.topLeftCorner<3, 3>() * Vec3f::UnitZ();
  EXPECT_NEAR(up.x(), 0.0f, 1e-6f);
  EXPECT_GT(up.y(), 0.0f);
}

TEST(ViewMatrix, IsFiniteLookingStraightDownAndUp) {
  for (const float height : {10.0f, -10.0f}) {
    const Mat4f view = view_matrix({{0.0f, 0.0f, height}, Vec3f::Zero(), 40.0f});
    ASSERT_TRUE(view.allFinite());
    const Vec3f north = view.topLeftCorner<3, 3>() * Vec3f::UnitY();
    EXPECT_TRUE(north.isApprox(Vec3f::UnitY())) << "+y is up in the picture";
  }
}

TEST(ProjectionMatrix, AgreesWithSimilarTriangles) {
  const Camera camera = {{2.0f, -7.0f, 3.0f}, {0.0f, 1.0f, 1.0f}, 50.0f};
  constexpr int width = 640;
  constexpr int height = 480;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> coordinate(-2.0f, 2.0f);
  for (int i = 0; i < 50; ++i) {
    const Vec3f point = {coordinate(random), coordinate(random), coordinate(random)};
    const Eigen::Vector4f p = clip(camera, 4.0f / 3.0f, point);
    const Eigen::Vector2d expected = seen_at(camera, point, width, height);
    // Single precision times hundreds of pixels.
    EXPECT_NEAR((p.x() / p.w() * 0.5 + 0.5) * width, expected.x(), 1e-3);
    EXPECT_NEAR((0.5 - p.y() / p.w() * 0.5) * height, expected.y(), 1e-3);
  }
}

TEST(ProjectionMatrix, MapsNearAndFarToTheEndsOfDepth) {
  const Mat4f projection = projection_matrix(40.0f, 1.5f, 0.5f, 20.0f);
  const Eigen::Vector4f near = projection * Eigen::Vector4f(0, 0, -0.5f, 1);
  const Eigen::Vector4f far = projection * Eigen::Vector4f(0, 0, -20.0f, 1);
  EXPECT_NEAR(near.z() / near.w(), -1.0f, 1e-5f);
  EXPECT_NEAR(far.z() / far.w(), 1.0f, 1e-5f);
}

TEST(LookAtBounds, StandsWhereTheAnglesSay) {
  const Box box = {Vec3f::Constant(-1.0f), Vec3f::Constant(1.0f)};
  const auto direction_of = [&box](float azimuth, float elevation) {
    const Camera camera = look_at_bounds(box, {azimuth, elevation}, 40.0f, 1.0f);
    return Vec3f((camera.eye - camera.target).normalized());
  };
  EXPECT_TRUE(direction_of(0, 0).isApprox(Vec3f(0, -1, 0), 1e-5f));
  EXPECT_LT((direction_of(90, 0) - Vec3f(1, 0, 0)).norm(), 1e-5f);
  EXPECT_LT((direction_of(180, 0) - Vec3f(0, 1, 0)).norm(), 1e-5f);
  EXPECT_LT((direction_of(0, 90) - Vec3f(0, 0, 1)).norm(), 1e-5f);
  EXPECT_NEAR(direction_of(30, 25).z(), std::sin(25.0 * std::numbers::pi / 180.0), 1e-5);
}

/// Draws boxes, directions, angles and shapes at random.
struct RandomView {
  explicit RandomView(std::uint32_t seed) : random(seed) {
    const Vec3f a = {in(-50, 50), in(-50, 50), in(-50, 50)};
    box = {a, a + Vec3f(in(0, 20), in(0, 20), in(0, 20))};
    direction = {in(-360, 360), in(-90, 90)};
    field_of_view = in(5, 110);
    aspect = in(0.4f, 3.0f);
    margin = in(0.0f, 0.5f);
  }
  float in(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  }
  std::mt19937 random;
  Box box;
  ViewDirection direction;
  float field_of_view;
  float aspect;
  float margin;
};

class LookAtBoundsProperty : public testing::TestWithParam<std::uint32_t> {};

TEST_P(LookAtBoundsProperty, HasAllCornersInViewAndOnePairOfSidesAtTheMargin) {
  const RandomView v(GetParam());
  const Camera camera = look_at_bounds(v.box, v.direction, v.field_of_view, v.aspect, v.margin);
  float widest = 0.0f;
  Eigen::Vector2f low = Eigen::Vector2f::Ones();
  Eigen::Vector2f high = -Eigen::Vector2f::Ones();
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector4f p = clip(camera, v.aspect, v.box.corner(i));
    ASSERT_GT(p.w(), 0.0f) << "a corner lies behind the eye";
    const Eigen::Vector2f seen = p.head<2>() / p.w();
    widest = std::max(widest, seen.cwiseAbs().maxCoeff());
    low = low.cwiseMin(seen);
    high = high.cwiseMax(seen);
  }
  // Single precision at coordinates near 50 and a box that may be a hundred times smaller.
  constexpr float rounding = 2e-3f;
  EXPECT_NEAR(widest, 1.0f - v.margin, rounding) << "not the nearest such camera";
  const Eigen::Vector2f middle = 0.5f * (low + high);
  const int tight = (high - low).x() > (high - low).y() ? 0 : 1;
  EXPECT_NEAR(middle[tight], 0.0f, rounding) << "not centred";
}

INSTANTIATE_TEST_SUITE_P(Random, LookAtBoundsProperty, testing::Range(0u, 60u));

TEST(LookAtBounds, RefusesWhatCannotBeSeen) {
  const Box box = {Vec3f::Zero(), Vec3f::Ones()};
  EXPECT_THROW(look_at_bounds(Box{}, {}, 40.0f, 1.0f), std::invalid_argument);
  EXPECT_THROW(look_at_bounds({Vec3f::Zero(), Vec3f::Constant(NAN)}, {}, 40.0f, 1.0f),
               std::invalid_argument);
  EXPECT_THROW(look_at_bounds(box, {0.0f, 91.0f}, 40.0f, 1.0f), std::invalid_argument);
  EXPECT_THROW(look_at_bounds(box, {NAN, 0.0f}, 40.0f, 1.0f), std::invalid_argument);
  EXPECT_THROW(look_at_bounds(box, {}, 0.5f, 1.0f), std::invalid_argument);
  EXPECT_THROW(look_at_bounds(box, {}, 40.0f, 0.0f), std::invalid_argument);
  EXPECT_THROW(look_at_bounds(box, {}, 40.0f, 1.0f, 1.0f), std::invalid_argument);
}

TEST(LookAtBounds, StandsOffFromABoxWithoutSize) {
  const Vec3f point = {1.0f, 2.0f, 3.0f};
  const Camera camera = look_at_bounds({point, point}, {10.0f, 20.0f}, 40.0f, 1.0f);
  EXPECT_TRUE(camera.eye.allFinite());
  EXPECT_GT((camera.eye - camera.target).norm(), 0.0f);
}

/// A margin on each side, to tell them apart.
ViewFit fit_of_four_margins() {
  return ViewFit({35.0f, 20.0f}, 40.0f, 1.5f, {0.1f, 0.05f, 0.3f}, {1, 2, 3});
}

TEST(ViewFit, OfACircleIsThatOfItsPoints) {
  const Vec3f centre = {2, 1, 4};
  ViewFit circle = fit_of_four_margins(), points = fit_of_four_margins();
  circle.add_circle(centre, 3.0f);
  for (int i = 0; i < 3600; ++i) {
    const float angle = static_cast<float>(i) * std::numbers::pi_v<float> / 1800.0f;
    points.add(centre + 3.0f * Vec3f(std::cos(angle), std::sin(angle), 0.0f));
  }
  // Half of 0.1 degree leaves 3 m * 4e-7 of the circle; the rest is rounding.
  EXPECT_LT((circle.camera().eye - points.camera().eye).norm(), 1e-5f);
  EXPECT_LT((circle.camera().target - points.camera().target).norm(), 1e-5f);
}

TEST(ViewFit, GoesOnWithWhatAnotherHasSeen) {
  const std::vector<Vec3f> points = {{3, 1, 2}, {-2, 4, 9}, {5, -3, 1}, {0, 0, 5}};
  ViewFit all = fit_of_four_margins(), first = fit_of_four_margins(), rest = fit_of_four_margins();
  for (std::size_t i = 0; i < points.size(); ++i) {
    all.add(points[i]);
    (i < 2 ? first : rest).add(points[i]);
  }
  EXPECT_NE(rest.seen(), all.seen());
  rest.include(first.seen());
  EXPECT_EQ(rest.seen(), all.seen());
  EXPECT_EQ(rest.camera().eye, all.camera().eye);
}

TEST(ViewFit, LeavesItsMarginsFreeAndNoMore) {
  const Margins margins = {0.1f, 0.05f, 0.3f};
  ViewFit fit({35.0f, 20.0f}, 40.0f, 1.5f, margins, {1, 2, 3});
  std::vector<Vec3f> points;
  for (int i = 0; i < 200; ++i) {
    const auto number = static_cast<float>(i);
    points.push_back(
        {1 + 3 * std::sin(7 * number), 2 + std::cos(number), 3 + std::sin(3 * number)});
    fit.add(points.back());
  }
  const Camera camera = fit.camera();
  const Mat4f to_clip = projection_matrix(40.0f, 1.5f, 0.1f, 100.0f) * view_matrix(camera);
  Box seen;
  for (const Vec3f& point : points) {
    const Eigen::Vector4f clip = to_clip * point.homogeneous();
    seen.grow(clip.head<3>() / clip.w());
  }
  const float rounding = 1e-4f;
  EXPECT_LE(seen.max.x(), 0.9f + rounding);
  EXPECT_GE(seen.min.x(), -0.9f - rounding);
  EXPECT_LE(seen.max.y(), 0.95f + rounding);
  EXPECT_GE(seen.min.y(), -0.7f - rounding);
  // Nearer is not possible: one direction is filled from side to side.
  const bool wide = seen.max.x() > 0.9f - rounding && seen.min.x() < -0.9f + rounding;
  const bool high = seen.max.y() > 0.95f - rounding && seen.min.y() < -0.7f + rounding;
  EXPECT_TRUE(wide || high) << seen.min.transpose() << " to " << seen.max.transpose();
}

}  // namespace
}  // namespace pneuma::render
