// What straight edges throw on the ground is straight, too, however coarse the picture of it is.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/render/probe.h"
#include "tests/render/shapes.h"

namespace pneuma::render {
namespace {

constexpr float height = 0.3f, half = 2.5f;  // m, of the box

/// Between the middles of four pixels.
double green_at(const Image& image, const Eigen::Vector2d& place) {
  const int x = static_cast<int>(place.x() - 0.5), y = static_cast<int>(place.y() - 0.5);
  const double right = place.x() - 0.5 - x, down = place.y() - 0.5 - y;
  const auto across = [&](int row) {
    return std::lerp(static_cast<double>(pixel_at(image, x, row)[1]),
                     static_cast<double>(pixel_at(image, x + 1, row)[1]), right);
  };
  return std::lerp(across(y), across(y + 1), down);
}

/// A box on the ground below the eye, 16 pixels to a metre. What stands far away makes the texels
/// of shadows large: five pixels wide.
class TurnedBox : public testing::TestWithParam<float> {
 protected:
  TurnedBox() {
    frame_.camera = {{0, 0, 20}, Vec3f::Zero(), 40.0f};
    frame_.light.direction = {1, 0, -1};  // it shifts a shadow by the height of its caster
    frame_.ground = Ground{0.001f};       // lines too close to be seen
    Mesh box = make_box({0, 0, 0.5f * height}, {2 * half, 2 * half, height}, {0.8f, 0.8f, 0.8f});
    for (Vec3f& position : box.positions) position = turn_ * position;
    frame_.meshes = {box, make_box({-40, 0, 0.5f}, {1, 1, 1}, {0.8f, 0.8f, 0.8f})};
  }

  /// Bytes (root of the mean square) between the ground's brightness and a parabola through it,
  /// along a line that lies `away` from the box's side number `side` and is shifted.
  double unevenness(const Image& image, int side, float away, const Vec3f& shift) const {
    constexpr int count = 61;
    const Eigen::AngleAxisf to_side(1.5707963f * static_cast<float>(side), Vec3f::UnitZ());
    Eigen::MatrixX3d powers(count, 3);
    Eigen::VectorXd green(count);
    for (int i = 0; i < count; ++i) {
      const float along = 0.03f * static_cast<float>(i - count / 2);
      const Vec3f point = turn_ * (to_side * Vec3f(half + away, along, 0)) + shift;
      powers.row(i) << 1.0, along, along * along;
      green(i) = green_at(image, seen_at(frame_.camera, point, image.width, image.height));
    }
    const Eigen::Vector3d fit = powers.colPivHouseholderQr().solve(green);
    return (powers * fit - green).norm() / std::sqrt(static_cast<double>(count));
  }

  Frame frame_;
  Eigen::AngleAxisf turn_{GetParam(), Vec3f::UnitZ()};
};
INSTANTIATE_TEST_SUITE_P(By, TurnedBox, testing::Values(0.2f, 0.45f, 0.7f, 1.1f, 1.4f));

TEST_P(TurnedBox, DarkensTheGroundEvenlyAlongItsFoot) {
  const Image image = draw_once(frame_, small_picture());
  for (int side = 0; side < 4; ++side) {
    EXPECT_LT(unevenness(image, side, 0.2f, Vec3f::Zero()), 2.0) << side;
  }
}

TEST_P(TurnedBox, HasAShadowWithStraightEdges) {
  frame_.light.between_bodies = false;
  const int side = GetParam() < 0.785f ? 0 : 3;  // the one that is turned from the light most
  for (const float softness : {0.0f, 0.012f}) {
    frame_.light.softness = softness;
    const Image image = draw_once(frame_, small_picture());
    for (const float away : {-0.1f, 0.0f, 0.1f}) {
      EXPECT_LT(unevenness(image, side, away, {height, 0, 0}), 1.5) << softness << ' ' << away;
    }
  }
}

}  // namespace
}  // namespace pneuma::render
