// Bounding spheres hold their bodies, and the sweep finds the same pairs as trying them all.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <limits>
#include <random>

#include "sim/collision/sweep_and_prune.h"
#include "sim/mesh/primitives.h"

namespace pneuma::sim {
namespace {

TEST(BoundingSphere, HoldsEveryVertexAndTouchesOne) {
  VertexArray positions = to_vertex_array(make_torus(4.0, 1.5, 16, 16).vertices);
  for (int i = 0; i < positions.size(); ++i) positions[i] += Vec3(100.0, -20.0, 3.0);
  const BoundingSphere sphere = bounding_sphere(positions, 0.0);
  double farthest = 0.0;
  for (int i = 0; i < positions.size(); ++i) {
    farthest = std::max(farthest, (positions[i] - sphere.centre).norm());
  }
  EXPECT_NEAR(sphere.radius, farthest, 1e-13);  // roundings of coordinates of 100
  // Closed form: the torus is centred and its outermost circle has radius 4 + 1.5.
  EXPECT_NEAR(sphere.radius, 5.5, 1e-13);
  EXPECT_NEAR((sphere.centre - Vec3(100.0, -20.0, 3.0)).norm(), 0.0, 1e-13);
}

// ERRATA row 10: bodies apart by less than the reach of two margins must be a pair.
TEST(BoundingSphere, MarginsCoverTheReach) {
  const double skin = 0.5;
  const auto ball_at = [&](double x) {
    VertexArray positions = to_vertex_array(make_icosphere(1.0, 2).vertices);
    for (int i = 0; i < positions.size(); ++i) positions[i] += Vec3(x, 0.0, 0.0);
    return bounding_sphere(positions, skin);
  };
  EXPECT_TRUE(overlap(ball_at(0.0), ball_at(2.0 + 2.0 * skin - 1e-12)));
  EXPECT_FALSE(overlap(ball_at(0.0), ball_at(2.0 + 2.0 * skin + 1e-12)));
}

TEST(BoundingSphere, OfABoxReachesItsCorners) {
  OrientedBox box;
  box.centre = {1.0, 2.0, 3.0};
  box.half = {2.0, 3.0, 6.0};
  const BoundingSphere sphere = bounding_sphere(box, 0.25);
  EXPECT_EQ(sphere.centre, box.centre);
  EXPECT_EQ(sphere.radius, 7.25);  // 2, 3, 6, 7 is a Pythagorean quadruple
}

std::vector<BodyPair> try_all(const std::vector<BoundingSphere>& spheres) {
  std::vector<BodyPair> pairs;
  for (int i = 0; i < static_cast<int>(spheres.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(spheres.size()); ++j) {
      const BoundingSphere& a = spheres[at(i)];
      const BoundingSphere& b = spheres[at(j)];
      if ((a.centre - b.centre).norm() <= a.radius + b.radius) pairs.push_back({i, j});
    }
  }
  return pairs;
}

/// Spheres of radius 0.2 to 2 in a box of such a shape, filled so that each meets a few others.
std::vector<BoundingSphere> scatter(int count, const Vec3& shape, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double size = 2.0 * std::cbrt(count / shape.prod());
  std::vector<BoundingSphere> spheres;
  for (int i = 0; i < count; ++i) {
    const double x = unit(random);
    const double y = unit(random);
    const double z = unit(random);
    spheres.push_back(
        {size * Vec3(x, y, z).cwiseProduct(shape), 0.2 + 1.8 * std::pow(unit(random), 3)});
  }
  return spheres;
}

TEST(SweepAndPrune, FindsThePairsThatTryingAllFinds) {
  SweepAndPrune finder;
  std::vector<BodyPair> pairs;
  unsigned seed = 0;
  std::size_t total = 0;
  for (const Vec3& shape : {Vec3(1, 1, 1), Vec3(100, 1, 1), Vec3(1, 30, 1), Vec3(1, 1, 0.01)}) {
    for (const int count : {0, 1, 2, 3, 10, 100, 1000}) {
      for (int repeat = 0; repeat < 5; ++repeat) {
        const auto spheres = scatter(count, shape, ++seed);
        finder.find(spheres, pairs);
        ASSERT_EQ(pairs, try_all(spheres)) << "seed " << seed;
        total += pairs.size();
      }
    }
  }
  EXPECT_GT(total, 10'000U);
}

std::vector<BodyPair> try_all(const std::vector<Bounds>& boxes) {
  std::vector<BodyPair> pairs;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(boxes.size()); ++j) {
      const Bounds &a = boxes[at(i)], &b = boxes[at(j)];
      if ((a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all()) {
        pairs.push_back({i, j});
      }
    }
  }
  return pairs;
}

/// Cubes that spheres just fit into, one of them not a number.
TEST(SweepAndPrune, FindsThePairsOfBoxesThatTryingAllFinds) {
  SweepAndPrune finder;
  std::vector<BodyPair> pairs;
  for (const Vec3& shape : {Vec3(1, 1, 1), Vec3(100, 1, 1), Vec3(1, 30, 1), Vec3(1, 1, 0.01)}) {
    std::vector<Bounds> boxes;
    for (const BoundingSphere& sphere : scatter(500, shape, 7)) {
      const Vec3 half = Vec3::Constant(sphere.radius);
      boxes.push_back({sphere.centre - half, sphere.centre + half});
    }
    boxes[3].high.y() = std::numeric_limits<double>::quiet_NaN();
    finder.find(boxes, pairs);
    EXPECT_EQ(pairs, try_all(boxes));
    EXPECT_GT(pairs.size(), 200U);
  }
}

TEST(SweepAndPrune, TouchingAndConcentricSpheresArePairs) {
  SweepAndPrune finder;
  std::vector<BodyPair> pairs;
  const std::vector<BoundingSphere> spheres{
      {Vec3(0, 0, 0), 1.0}, {Vec3(3, 0, 0), 2.0}, {Vec3(3, 0, 0), 2.0}, {Vec3(8, 0, 0), 2.5}};
  finder.find(spheres, pairs);
  EXPECT_EQ(pairs, (std::vector<BodyPair>{{0, 1}, {0, 2}, {1, 2}}));
}

// A body that has blown up must not take the others with it.
TEST(SweepAndPrune, IgnoresSpheresThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  auto spheres = scatter(200, Vec3::Ones(), 1);
  auto expected = try_all(spheres);
  SweepAndPrune finder;
  std::vector<BodyPair> pairs;
  for (std::size_t i = 0; i < spheres.size(); i += 3) {
    if (i % 2 == 0) spheres[i].centre[static_cast<int>(i % 9 / 3)] = i % 4 == 0 ? nan : infinity;
    if (i % 2 == 1) spheres[i].radius = i % 4 == 1 ? nan : infinity;
  }
  std::erase_if(expected, [](const BodyPair& p) { return p.first % 3 == 0 || p.second % 3 == 0; });
  finder.find(spheres, pairs);
  EXPECT_EQ(pairs, expected);
}

// A twentieth, measured; a quarter leaves room for a busy machine. Processor time, best of five.
TEST(SweepAndPruneTiming, IsAFractionOfThatOfTryingAll) {
  const auto spheres = scatter(10'000, Vec3::Ones(), 1);
  SweepAndPrune finder;
  std::vector<BodyPair> pairs;
  const auto clocks = [](auto work) {
    std::clock_t best = std::numeric_limits<std::clock_t>::max();
    for (int repeat = 0; repeat < 5; ++repeat) {
      const std::clock_t start = std::clock();
      work();
      best = std::min(best, std::clock() - start);
    }
    return best;
  };
  const auto sweep = clocks([&] { finder.find(spheres, pairs); });
  const auto all = clocks([&] { ASSERT_EQ(try_all(spheres).size(), pairs.size()); });
  EXPECT_LT(sweep, all / 4);
}

}  // namespace
}  // namespace pneuma::sim
