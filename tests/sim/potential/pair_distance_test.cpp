// Distances of pairs against the searches of sim/swept and differences, in every region of a pair.
#include "sim/potential/pair_distance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <map>

#include "sim/potential/barrier.h"
#include "sim/potential/mollifier.h"
#include "sim/swept/closest_points.h"
#include "tests/sim/potential/pair_samples.h"

namespace pneuma::sim {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int samples = 2000;

using Nearest = PairPoint (*)(const PairCorners&);

double other_distance(const PairCorners& x, bool is_edges) {
  if (is_edges) return closest_edge_edge({x[0], x[1]}, {x[2], x[3]}, infinite)->distance;
  return closest_vertex_triangle(x[0], {x[1], x[2], x[3]}, infinite)->distance;
}

/// Whether all corners moved a little are still nearest in the same region.
bool is_inside_region(Nearest nearest, const PairCorners& x, double width) {
  const PairPoint point = nearest(x);
  for (int i = 0; i < 12; ++i) {
    for (const double by : {-width, width}) {
      const PairPoint other = nearest(moved(x, i, by));
      if (other.slides != point.slides) return false;
      for (std::size_t c = 0; c < 4; ++c) {
        if ((other.weights[c] == 0.0) != (point.weights[c] == 0.0)) return false;
      }
    }
  }
  return true;
}

class PairDistance : public testing::TestWithParam<bool> {
 protected:
  Nearest nearest() const { return GetParam() ? nearest_edge_edge : nearest_vertex_triangle; }
};

TEST_P(PairDistance, IsThatOfTheSweptSearch) {
  std::mt19937_64 random(1);
  for (int i = 0; i < samples; ++i) {
    const PairCorners x = random_corners(random);
    const PairPoint point = nearest()(x);
    EXPECT_NEAR(point.distance, other_distance(x, GetParam()), 1e-12);
    EXPECT_NEAR(point.apart.norm(), point.distance, 1e-15);
    double sum = 0.0;
    for (const double weight : point.weights) sum += weight;
    EXPECT_NEAR(sum, 0.0, 1e-15);
  }
}

TEST_P(PairDistance, HasItsDifferencesAsDerivativesInEveryRegion) {
  constexpr double width = 1e-6;
  std::mt19937_64 random(2);
  std::map<int, int> regions;  // by number of slides
  for (int i = 0; i < samples; ++i) {
    const PairCorners x = random_corners(random);
    const PairPoint point = nearest()(x);
    // Near to touching the second derivative is as great as 1 / distance, and differences blur it.
    if (point.distance < 0.1 || !is_inside_region(nearest(), x, 1e-3)) continue;
    // Nearly parallel edges are nearest in places that shift far by little.
    if (GetParam() && squared_cross(x) < 0.1) continue;
    ++regions[point.slides];
    const auto distance = [&](const PairCorners& at_x) { return nearest()(at_x).distance; };
    const auto gradient = [&](const PairCorners& at_x) {
      return distance_gradient(nearest()(at_x));
    };
    const Vec12 slope = distance_gradient(point);
    EXPECT_LT((slope - difference_gradient(distance, x, width)).norm(), 1e-8);
    const Mat12 curvature = distance_hessian(x, point);
    EXPECT_LT((curvature - difference_hessian(gradient, x, width)).norm(),
              1e-6 * (1.0 + curvature.norm()));
    EXPECT_LT((curvature - curvature.transpose()).norm(), 1e-12 * (1.0 + curvature.norm()));
  }
  for (const int slides : {0, 1, 2}) EXPECT_GT(regions[slides], 20) << slides << " slides";
}

TEST_P(PairDistance, DoesNotChangeWhereAllMovesAlike) {
  std::mt19937_64 random(3);
  const PairCorners x = random_corners(random);
  const PairPoint point = nearest()(x);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  const Vec12 gradient = distance_gradient(point);
  for (int i = 0; i < 4; ++i) {
    force += gradient.segment<3>(3 * i);
    torque += x[at(i)].cross(gradient.segment<3>(3 * i));
  }
  EXPECT_LT(force.norm(), 1e-15);
  EXPECT_LT(torque.norm(), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Pairs, PairDistance, testing::Bool(), [](const auto& parameters) {
  return parameters.param ? "TwoEdges" : "VertexAndTriangle";
});

TEST(PairDistance, OfParallelAndPointLikeFeaturesIsThatOfTheirEnds) {
  const PairCorners parallel = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(1, 0.5, 0), Vec3(3, 0.5, 0)};
  EXPECT_DOUBLE_EQ(nearest_edge_edge(parallel).distance, 0.5);
  const PairCorners points = {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(3, 4, 0), Vec3(3, 4, 0)};
  EXPECT_DOUBLE_EQ(nearest_edge_edge(points).distance, 5.0);
  const PairCorners needle = {Vec3(1, 1, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  EXPECT_DOUBLE_EQ(nearest_vertex_triangle(needle).distance, 1.0);
}

TEST(PositivePart, KeepsWhatIsPositiveAndNothingElse) {
  std::mt19937_64 random(4);
  Mat12 matrix = Mat12::Zero();
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      matrix(i, j) = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
    }
  }
  const Mat12 symmetric = matrix + matrix.transpose();
  const Mat12 positive = positive_part(symmetric);
  const Eigen::SelfAdjointEigenSolver<Mat12> before(symmetric), after(positive);
  EXPECT_LT(before.eigenvalues().minCoeff(), -0.1);
  EXPECT_LT((after.eigenvalues() - before.eigenvalues().cwiseMax(0.0)).norm(), 1e-13);
  EXPECT_LT((positive_part(positive) - positive).norm(), 1e-13);
}

TEST(Mollifier, HasItsDifferencesAsDerivativesAndJoinsOneSmoothly) {
  std::mt19937_64 random(5);
  int below = 0;
  for (int i = 0; i < 200; ++i) {
    const PairCorners x = random_corners(random);
    constexpr double threshold = 0.7;
    const Mollifier m = mollifier(x, threshold);
    if (squared_cross(x) < threshold) ++below;
    const auto value = [&](const PairCorners& at_x) {
      return mollifier_value(squared_cross(at_x), threshold);
    };
    const auto gradient = [&](const PairCorners& at_x) -> Vec12 {
      return mollifier(at_x, threshold).gradient;
    };
    EXPECT_LT((m.gradient - difference_gradient(value, x, 1e-6)).norm(), 1e-8);
    EXPECT_LT((m.hessian - difference_hessian(gradient, x, 1e-6)).norm(), 1e-6);
  }
  EXPECT_GT(below, 50);
  EXPECT_DOUBLE_EQ(mollifier_value(0.0, 1.0), 0.0);
  EXPECT_NEAR(mollifier_value(1.0 - 1e-9, 1.0), 1.0, 1e-15);
}

template <class Function>
void expect_derivatives(const Function& function, double at_x) {
  constexpr double width = 1e-5;
  const FunctionValue f = function(at_x);
  EXPECT_NEAR(f.slope,
              (function(at_x + width).value - function(at_x - width).value) / (2.0 * width),
              1e-7 * (1.0 + std::abs(f.curvature) / at_x));
  EXPECT_NEAR(f.curvature,
              (function(at_x + width).slope - function(at_x - width).slope) / (2.0 * width),
              1e-5 * (1.0 + std::abs(f.curvature) / at_x));
}

TEST(Barrier, HasItsDifferencesAsDerivatives) {
  for (const double s : {0.01, 0.1, 0.5, 0.9, 0.999, 1.5}) {
    expect_derivatives(barrier, s);
    expect_derivatives(smooth_friction, s);
    expect_derivatives(parting_ramp, s);
  }
}

TEST(Barrier, IsTwiceSmoothAtItsReachAndUnboundedAtZero) {
  const FunctionValue at_reach = barrier(1.0 - 1e-7);
  EXPECT_LT(std::abs(at_reach.value), 1e-20);
  EXPECT_LT(std::abs(at_reach.slope), 1e-13);
  EXPECT_LT(std::abs(at_reach.curvature), 1e-6);
  EXPECT_GT(barrier(1e-300).value, 600.0);
  EXPECT_EQ(barrier(0.0).value, infinite);
  EXPECT_EQ(barrier(-1.0).value, infinite);
}

}  // namespace
}  // namespace pneuma::sim
