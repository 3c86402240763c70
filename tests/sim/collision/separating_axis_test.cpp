// When boxes overlap, and which way they part soonest; points in a box.
#include "sim/collision/separating_axis.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/sim/collision/box_samples.h"

namespace pneuma::sim {
namespace {

TEST(Box, ExitAgreesWithItsSixFacesOn100000Points) {
  BoxRandom random(1);
  int inside = 0;
  for (int i = 0; i < 100'000; ++i) {
    const OrientedBox box = random.box();
    const Vec3 point = box.centre + box.axes * box.half.cwiseProduct(1.3 * random.point());
    // Section 5.2.2 as written: a point t of each face and its outward normal n.
    double largest = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      for (const double side : {-1.0, 1.0}) {
        const Vec3 n = side * box.axes.col(k);
        const Vec3 t = box.corner(side > 0.0 ? 7 : 0);
        largest = std::max(largest, (point - t).dot(n));
      }
    }
    const auto exit = find_box_exit(box, point);
    if (std::abs(largest) < rounding) continue;
    ASSERT_EQ(exit.has_value(), largest < 0.0);
    if (!exit) continue;
    ++inside;
    ASSERT_NEAR(exit->depth, -largest, rounding);
    ASSERT_NEAR((exit->point - point).dot(exit->normal), exit->depth, rounding);
    // The way out ends on the surface, and on the face named.
    const Vec3 local = box.to_local(exit->point);
    ASSERT_NEAR((local.cwiseAbs() - box.half).maxCoeff(), 0.0, rounding);
    const double side = exit->face % 2 == 0 ? 1.0 : -1.0;
    ASSERT_NEAR(local[exit->face / 2], side * box.half[exit->face / 2], rounding);
  }
  EXPECT_GT(inside, 20'000);
}

TEST(SeparatingAxis, AgreesWithClippedEdgesOn100000Pairs) {
  BoxRandom random(2);
  int overlapping = 0;
  int undecided = 0;
  for (int i = 0; i < 100'000; ++i) {
    const auto [first, second] = sample_boxes(random, i % box_relations);
    const bool truth = reference_overlap(first, second);
    const bool found = find_min_overlap(first, second).has_value();
    if (truth != found && reference_overlap(grown(first, rounding), second) !=
                              reference_overlap(grown(first, -rounding), second)) {
      ++undecided;
      continue;
    }
    ASSERT_EQ(found, truth) << "pair " << i << ", relation " << i % box_relations;
    overlapping += truth ? 1 : 0;
  }
  EXPECT_GT(overlapping, 20'000);
  EXPECT_LT(overlapping, 80'000);
  EXPECT_EQ(undecided, 0);
}

/// The least overlap along the fifteen axes, each taken as it comes; negative when one separates.
double least_of_fifteen_axes(const OrientedBox& first, const OrientedBox& second) {
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vec3& u) {
    const double distance = std::abs((first.centre - second.centre).dot(u));
    least = std::min(least, extent(first, u) + extent(second, u) - distance);
  };
  for (int a = 0; a < 3; ++a) {
    look(first.axes.col(a));
    look(second.axes.col(a));
    for (int b = 0; b < 3; ++b) {
      const Vec3 across = first.axes.col(a).cross(second.axes.col(b));
      if (across.norm() >= 1e-10) look(across.normalized());
    }
  }
  return least;
}

// No axis is passed over that decides, however nearly parallel the edges that it comes from.
TEST(SeparatingAxis, MissesNoneOfTheFifteenAxes) {
  BoxRandom random(7);
  int overlapping = 0, apart = 0;
  for (int i = 0; i < 100'000; ++i) {
    const auto [first, second] = sample_boxes(random, i % box_relations);
    const double expected = least_of_fifteen_axes(first, second);
    const auto found = find_min_overlap(first, second);
    if (!found) {
      ++apart;
      ASSERT_LT(expected, rounding) << i;
      continue;
    }
    ++overlapping;
    const double slack = 0.001 * std::min(first.half.minCoeff(), second.half.minCoeff());
    ASSERT_GT(expected, -rounding) << i;
    ASSERT_GT(found->overlap, expected - rounding) << i;
    // A face may be preferred to another by 0.95 and the slack, and to edges likewise.
    ASSERT_LT(found->overlap, (expected + slack) / 0.95 + rounding) << i;
    if (found->kind == AxisKind::edges) {
      ASSERT_NEAR(found->overlap, expected, rounding) << i;
    }
  }
  EXPECT_GT(overlapping, 20'000);
  EXPECT_GT(apart, 20'000);
}

// Two cubes on edge, one above the other, their edges all but parallel and a hair apart. The faces'
// normals do not see the gap, since along them each edge reaches past the other by half its length
// times the angle; only the cross product of the two edges does.
TEST(SeparatingAxis, SeesAGapBetweenNearlyParallelEdges) {
  const Mat3 on_edge = turn(Vec3::UnitX(), std::numbers::pi / 4.0);
  for (const double angle : {1e-1, 1e-3, 1e-5, 1e-7}) {
    OrientedBox lower;
    lower.axes = on_edge;
    OrientedBox upper;
    upper.axes = turn(Vec3::UnitZ(), angle) * on_edge;
    for (const double gap : {0.01 * angle, -0.01 * angle}) {
      upper.centre.z() = 2.0 * std::sqrt(0.5) + gap;
      EXPECT_EQ(find_min_overlap(upper, lower).has_value(), gap < 0.0) << angle << " " << gap;
      EXPECT_EQ(reference_overlap(upper, lower), gap < 0.0) << angle << " " << gap;
    }
  }
}

// The overlap is the shortest way that parts the boxes, but for the documented preference of faces.
TEST(SeparatingAxis, OverlapIsTheShortestWayApart) {
  BoxRandom random(3);
  int pairs = 0;
  int minimal = 0;
  for (int i = 0; i < 20'000; ++i) {
    const BoxPair pair = sample_boxes(random, i % box_relations);
    const OrientedBox& first = pair.first;
    const OrientedBox& second = pair.second;
    const auto least = find_min_overlap(first, second);
    if (!least) continue;
    ++pairs;
    ASSERT_NEAR(least->normal.norm(), 1.0, 1e-15);
    // Along the normal it parts them.
    const double overlap = least->overlap;
    const Vec3 apart = (overlap * (1.0 + 1e-9) + rounding) * least->normal;
    ASSERT_FALSE(reference_overlap(moved(first, apart), second)) << i;
    // A shorter way, in whatever direction, does not, but for what the preference allows.
    const double slack = 0.001 * std::min(first.half.minCoeff(), second.half.minCoeff());
    const double shorter = std::max(0.0, 0.95 * overlap - slack - rounding);
    for (int k = 0; k < 20; ++k) {
      const Vec3 u = k == 0 ? least->normal : random.direction();
      ASSERT_TRUE(reference_overlap(moved(first, shorter * u), second)) << i;
    }
    // The same for many more directions, by the boxes' extents along them.
    double shortest = overlap;
    const auto look = [&](const Vec3& u) {
      const double along =
          extent(first, u) + extent(second, u) - std::abs((first.centre - second.centre).dot(u));
      shortest = std::min(shortest, along);
      ASSERT_GE(along, shorter) << i;
    };
    for (int k = 0; k < 200; ++k) look(random.direction());
    for (int k = 0; k < 50; ++k) look((least->normal + 0.1 * random.point()).normalized());
    for (int a = 0; a < 3; ++a) {
      look(first.axes.col(a));
      look(second.axes.col(a));
      for (int b = 0; b < 3; ++b) {
        const Vec3 across = first.axes.col(a).cross(second.axes.col(b));
        if (across.norm() > 1e-6) look(across.normalized());
      }
    }
    if (shortest > overlap - rounding) ++minimal;
  }
  EXPECT_GT(pairs, 4'000);
  EXPECT_GT(minimal, pairs / 2);
}

}  // namespace
}  // namespace pneuma::sim
