#include "app/record/shape_deviation.h"

#include <gtest/gtest.h>

#include "sim/mesh/rotation.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

/// Turned far and moved far away.
sim::SoftBody laid_down() {
  sim::SoftBody body = sim::make_body(sim::make_box({3.0, 2.0, 1.0}, 4));
  const sim::Mat3 rotation = sim::rotation_of_degrees({170.0, 60.0, -100.0}).toRotationMatrix();
  for (int v = 0; v < body.positions.size(); ++v) {
    body.positions[v] = sim::Vec3(100.0, -50.0, 20.0) + rotation * sim::Vec3(body.positions[v]);
  }
  return body;
}

TEST(ShapeDeviation, IsNoneOfARigidMotion) { EXPECT_LT(shape_deviation(laid_down()), 1e-14); }

TEST(ShapeDeviation, OfAnEvenGrowthIsThatOfTheFarthestCorner) {
  sim::SoftBody body = laid_down();
  const sim::Vec3 centre = sim::mean(body.positions);
  for (int v = 0; v < body.positions.size(); ++v) {
    body.positions[v] = centre + 1.1 * (sim::Vec3(body.positions[v]) - centre);
  }
  // Corners are half a diagonal away, and a tenth of that off.
  EXPECT_NEAR(shape_deviation(body), 0.05, 1e-12);
}

TEST(ShapeDeviation, IsThatOfAVertexAlone) {
  sim::SoftBody body = laid_down();
  const double diagonal = std::sqrt(14.0);
  body.positions[7] += 0.2 * diagonal * sim::Vec3::UnitZ();
  // One of 98 vertices moves and turns the best fit a little.
  EXPECT_NEAR(shape_deviation(body), 0.2, 0.01);
}

TEST(ShapeDeviation, TakesNoMirrorImageForTheShape) {
  sim::SoftBody body =
      sim::make_body({{{0.0, 0.0, 0.0}, {3.0, 0.0, 0.0}, {0.0, 2.0, 0.0}, {0.5, 0.5, 1.0}},
                      {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}});
  body.positions.rows().row(2) *= -1.0;
  EXPECT_GT(shape_deviation(body), 0.1);
}

}  // namespace
}  // namespace pneuma::app
