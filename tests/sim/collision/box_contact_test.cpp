// The points in which boxes touch: where they lie, and how deep they are.
#include "sim/collision/box_contact.h"

#include <gtest/gtest.h>

#include <optional>

#include "sim/collision/separating_axis.h"
#include "tests/sim/collision/box_samples.h"

namespace pneuma::sim {
namespace {

/// How far a point lies outside a box, negative inside.
double outside(const OrientedBox& box, const Vec3& point) {
  return (box.to_local(point).cwiseAbs() - box.half).maxCoeff();
}

/// How much of the direction is along one of the box's axes.
double along_a_face(const OrientedBox& box, const Vec3& direction) {
  return (box.axes.transpose() * direction).cwiseAbs().maxCoeff();
}

/// m along `normal`, below the face of the box that this direction leaves by, of a point over it.
double below_face(const OrientedBox& box, const Vec3& normal, const Vec3& point) {
  int axis = 0;
  const Vec3 along = box.axes.transpose() * normal;
  along.cwiseAbs().maxCoeff(&axis);
  const double height = std::copysign(1.0, along[axis]) * box.to_local(point)[axis];
  return std::abs(along[axis]) * (box.half[axis] - height);
}

/// Of two boxes that are apart, by projections onto one and the other in turn (Cheney and Goldstein
/// 1959).
double distance(const OrientedBox& first, const OrientedBox& second) {
  const auto nearest_in = [](const OrientedBox& box, const Vec3& point) {
    return box.to_world(box.to_local(point).cwiseMax(-box.half).cwiseMin(box.half));
  };
  Vec3 on_first = first.centre, on_second = second.centre;
  for (int i = 0; i < 1000; ++i) {
    on_second = nearest_in(second, on_first);
    on_first = nearest_in(first, on_second);
  }
  return (on_first - on_second).norm();
}

TEST(BoxContact, PointsLieInBothBoxesAndAreAsDeepAsTheySay) {
  BoxRandom random(4);
  int contacts = 0;
  int of_edges = 0;
  int of_shared_faces = 0;
  int of_more_than_four = 0;
  int beyond_a_thin_box = 0;
  for (int i = 0; i < 100'000; ++i) {
    const auto [first, second] = sample_boxes(random, i % box_relations);
    const auto contact = find_box_contact(first, second);
    const auto least = find_min_overlap(first, second);
    ASSERT_EQ(contact.has_value(), least.has_value());
    if (!contact) continue;
    ++contacts;
    of_more_than_four += contact->count > 4 ? 1 : 0;
    ASSERT_EQ(contact->normal, least->normal);
    ASSERT_EQ(contact->depth, least->overlap);
    ASSERT_GE(contact->count, 1);
    ASSERT_LE(contact->count, BoxContact::max_points);
    // The planes at right angles to the normal that touch the boxes, each on the other's side.
    const Vec3& n = contact->normal;
    const double bottom_of_first = first.centre.dot(n) - extent(first, n);
    const double top_of_second = second.centre.dot(n) + extent(second, n);
    // What a point may be deep without being out on the other side: the box with the face is that
    // thick across it; edges may lie in any direction.
    double thickness = 2.0 * std::min(first.half.minCoeff(), second.half.minCoeff());
    if (least->kind == AxisKind::first_face) thickness = 2.0 * first.half[least->first_axis];
    if (least->kind == AxisKind::second_face) thickness = 2.0 * second.half[least->second_axis];
    const auto& deepest = std::ranges::max(contact->points(), {}, &BoxContactPoint::depth);
    if (least->kind == AxisKind::edges) {
      ASSERT_NEAR(deepest.depth, contact->depth, 1e-6) << i;
    }
    for (const auto& [point, depth] : contact->points()) {
      ASSERT_GE(depth, 0.0);
      ASSERT_LE(depth, contact->depth + rounding);
      const double below = top_of_second - point.dot(n);
      const double above = point.dot(n) - bottom_of_first;
      switch (least->kind) {
        case AxisKind::first_face:
          ASSERT_NEAR(depth, above, rounding);
          ASSERT_NEAR(outside(second, point), 0.0, rounding);
          break;
        case AxisKind::second_face:
          ASSERT_NEAR(depth, below, rounding);
          ASSERT_NEAR(outside(first, point), 0.0, rounding);
          break;
        case AxisKind::edges:
          ++of_edges;
          if (std::abs(depth - 2.0 * above) > rounding) {
            // Of a face that the axis is along: on the one box, and so far in the other.
            ++of_shared_faces;
            const bool is_first = along_a_face(first, n) >= along_a_face(second, n);
            const OrientedBox &face = is_first ? first : second, &other = is_first ? second : first;
            ASSERT_GT(along_a_face(face, n), std::cos(0.1));
            ASSERT_NEAR(depth, below_face(face, is_first ? Vec3(-n) : n, point), rounding) << i;
            ASSERT_NEAR(outside(other, point), 0.0, rounding) << i;
            break;
          }
          ASSERT_NEAR(depth, 2.0 * above, rounding);
          ASSERT_NEAR(depth, 2.0 * below, rounding);
          break;
      }
      if (depth < thickness) {
        ASSERT_LE(outside(first, point), rounding) << i;
        ASSERT_LE(outside(second, point), rounding) << i;
      } else {
        ++beyond_a_thin_box;
      }
    }
  }
  EXPECT_GT(contacts, 30'000);
  EXPECT_GT(of_edges, 3'000);
  EXPECT_GT(of_shared_faces, 100);
  EXPECT_GT(of_more_than_four, 1'000);
  EXPECT_LT(beyond_a_thin_box, contacts / 3);
}

OrientedBox cube_at(const Vec3& centre, const Mat3& axes = Mat3::Identity()) {
  OrientedBox cube;
  cube.centre = centre;
  cube.axes = axes;
  return cube;
}

/// The contact of a unit cube a little in the top of another one below it.
std::optional<BoxContact> stacked(const OrientedBox& upper) {
  return find_box_contact(upper, cube_at(Vec3::Zero()));
}

TEST(BoxContact, OfStackedCubesIsTheSharedSquare) {
  const auto contact = stacked(cube_at({0.25, 0.0, 0.99}));
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->normal, Vec3::UnitZ().eval());
  EXPECT_NEAR(contact->depth, 0.01, 1e-15);
  ASSERT_EQ(contact->count, 4);
  Vec3 low = Vec3::Constant(10.0);
  Vec3 high = Vec3::Constant(-10.0);
  for (const BoxContactPoint& p : contact->points()) {
    EXPECT_NEAR(p.depth, 0.01, 1e-15);
    low = low.cwiseMin(p.point);
    high = high.cwiseMax(p.point);
  }
  EXPECT_NEAR(low.x(), -0.25, 1e-15);
  EXPECT_NEAR(high.x(), 0.5, 1e-15);
  EXPECT_NEAR(low.y(), -0.5, 1e-15);
  EXPECT_NEAR(high.y(), 0.5, 1e-15);
}

// A square on a square turned by 45 degrees: a regular octagon of apothem 1/2, whose corners are
// 1 / (2 cos 22.5 degrees) from the middle.
TEST(BoxContact, OfACubeTurnedByFortyFiveDegreesIsAnOctagon) {
  const auto contact =
      stacked(cube_at({0.0, 0.0, 0.99}, turn(Vec3::UnitZ(), std::numbers::pi / 4.0)));
  ASSERT_TRUE(contact);
  ASSERT_EQ(contact->count, 8);
  for (const BoxContactPoint& p : contact->points()) {
    EXPECT_NEAR(p.point.head<2>().norm(), 0.5 / std::cos(std::numbers::pi / 8.0), 1e-15);
    EXPECT_NEAR(p.depth, 0.01, 1e-15);
  }
}

// Two cubes on edge, one above the other, the edges crossing at right angles: each reaches
// sqrt(1/2) towards the other.
TEST(BoxContact, OfCrossedEdgesIsOnePointBetweenThem) {
  const double reach = std::sqrt(0.5);
  const Mat3 edge_along_x = turn(Vec3::UnitX(), std::numbers::pi / 4.0);
  const Mat3 edge_along_y = turn(Vec3::UnitY(), std::numbers::pi / 4.0);
  const auto contact = find_box_contact(cube_at({0.1, 0.2, 2.0 * reach - 0.02}, edge_along_x),
                                        cube_at(Vec3::Zero(), edge_along_y));
  ASSERT_TRUE(contact);
  EXPECT_NEAR((contact->normal - Vec3::UnitZ()).norm(), 0.0, 1e-15);
  EXPECT_NEAR(contact->depth, 0.02, 1e-15);
  ASSERT_EQ(contact->count, 1);
  EXPECT_NEAR((contact->all[0].point - Vec3(0.0, 0.2, reach - 0.01)).norm(), 0.0, 1e-15);
}

// Edges that touch so lightly that a face is preferred, which the other cube passes by its side:
// the one point left is the deepest corner, no farther beside the face than below it.
TEST(BoxContact, HasAPointWhereThePreferredFaceIsMissed) {
  const OrientedBox first =
      cube_at({-1.1998, -0.9244, 0.1273}, turn(Vec3(0.1, -0.6, -0.3).normalized(), 0.36));
  const OrientedBox second = cube_at(Vec3::Zero());
  ASSERT_TRUE(reference_overlap(first, second));
  const auto contact = find_box_contact(first, second);
  ASSERT_TRUE(contact);
  ASSERT_EQ(contact->count, 1);
  const auto& [point, depth] = contact->all[0];
  EXPECT_EQ(depth, contact->depth);
  EXPECT_LT(depth, 0.0005);
  const double beside = std::max(outside(first, point), outside(second, point));
  EXPECT_GT(beside, 0.0);
  EXPECT_LT(beside, depth);
}

// Two rods lie across each other. The upper one is turned by so little that its end is below the
// face of the lower one, far beside it: the axis that separates them most is of their edges. They
// touch in the square that they share.
TEST(BoxContactWithin, OfRodsThatCrossIsTheSquareThatTheyShare) {
  OrientedBox lower, upper;
  lower.half = {2.0, 0.1, 0.1};
  upper.half = {0.1, 2.0, 0.1};
  for (const double angle : {-0.004, -0.001, 0.001, 0.004}) {
    upper.axes = turn(Vec3(1.0, 0.3, 0.0).normalized(), angle);
    upper.centre = {0.0, 0.0, 0.201};
    ASSERT_EQ(find_min_overlap(upper, lower, 0.01)->kind, AxisKind::edges);
    const auto contact = find_box_contact_within(0.01, upper, lower);
    ASSERT_TRUE(contact);
    ASSERT_EQ(contact->count, 4);
    double area = 0.0;
    for (int i = 0; i < 4; ++i) {
      const auto& [point, depth] = contact->all[at(i)];
      const Vec3& next = contact->all[at((i + 1) % 4)].point;
      area += 0.5 * point.cross(next).z();
      // From the face of the lower one, z = 0.1, up to that of the upper one.
      const Vec3 normal = upper.axes.col(2), on_face = upper.centre - 0.1 * normal;
      const double gap = normal.dot(on_face - Vec3(point.x(), point.y(), 0.1)) / normal.z();
      EXPECT_NEAR(-depth, gap, 1e-5);
    }
    EXPECT_NEAR(std::abs(area), 0.04, 1e-6);
  }
}

TEST(BoxContact, PushesTheFirstBoxAwayWhicheverIsFirst) {
  const OrientedBox upper = cube_at({0.1, 0.2, 0.95});
  const OrientedBox lower = cube_at(Vec3::Zero());
  EXPECT_EQ(find_box_contact(upper, lower)->normal, Vec3::UnitZ().eval());
  EXPECT_EQ(find_box_contact(lower, upper)->normal, (-Vec3::UnitZ()).eval());
}

// Concentric boxes have no direction to the other's centre; flat and rod-like ones have faces far
// nearer than others.
TEST(BoxContact, IsFiniteForConcentricAndThinBoxes) {
  BoxRandom random(6);
  for (int i = 0; i < 10'000; ++i) {
    auto [first, second] = sample_boxes(random, i % box_relations);
    if (i % 2 == 0) second.centre = first.centre;
    if (i % 3 == 0) first.half[i % 7 % 3] = 1e-9;
    if (i % 5 == 0) second.half = Vec3(1e-9, 1e-9, 5.0);
    const auto contact = find_box_contact(first, second);
    if (!contact) continue;
    ASSERT_NEAR(contact->normal.norm(), 1.0, 1e-15);
    for (const BoxContactPoint& p : contact->points()) {
      ASSERT_TRUE(p.point.allFinite() && std::isfinite(p.depth));
    }
  }
}

/// Moved together along the normal by the overlap, they touch there.
TEST(BoxContactWithin, IsTheContactOfTheBoxesMovedTogether) {
  BoxRandom random(5);
  int apart = 0, beside = 0;
  for (int i = 0; i < 20'000; ++i) {
    auto [first, second] = sample_boxes(random, i % box_relations);
    const double reach = 0.5 * std::min(first.half.minCoeff(), second.half.minCoeff());
    const auto contact = find_box_contact_within(reach, first, second);
    const auto overlap = find_min_overlap(first, second, reach);
    ASSERT_TRUE(overlap || !contact);
    if (!contact) {
      if (!overlap) continue;
      // Apart, and nearest elsewhere than across these faces or edges.
      ASSERT_LT(overlap->overlap, 0.0);
      ASSERT_GT(distance(first, second), -overlap->overlap);
      ++beside;
      continue;
    }
    ASSERT_GE(contact->depth, -reach);
    ASSERT_GE(contact->count, 1);
    if (contact->depth >= 0.0) continue;
    ++apart;
    // No axis separates them by more than 5 % and some rounding beyond the one that was found.
    const double most = -1.06 * contact->depth + 0.002 * first.half.minCoeff();
    EXPECT_FALSE(find_min_overlap(first, second).has_value());
    EXPECT_TRUE(find_min_overlap(first, second, most).has_value());
    first.centre += (contact->depth - rounding) * contact->normal;
    const double extent_gap = first.centre.dot(contact->normal) - extent(first, contact->normal) -
                              second.centre.dot(contact->normal) - extent(second, contact->normal);
    ASSERT_NEAR(extent_gap, 0.0, 10.0 * rounding);
  }
  EXPECT_GT(apart, 1000);
  EXPECT_GT(beside, 40);
}

TEST(BoxContactWithin, ACubeOverAnotherHasItsFourCornersAtTheGap) {
  OrientedBox below, above;
  below.half = {1.0, 1.0, 1.0};
  above.half = {0.5, 0.5, 0.5};
  above.centre = {0.1, 0.2, 1.5 + 0.01};
  const auto contact = find_box_contact_within(0.02, above, below);
  ASSERT_TRUE(contact.has_value());
  EXPECT_EQ(contact->normal, Vec3::UnitZ());
  ASSERT_EQ(contact->count, 4);
  for (const auto& [point, depth] : contact->points()) EXPECT_NEAR(depth, -0.01, 1e-12);
  EXPECT_FALSE(find_box_contact_within(0.005, above, below).has_value());
}

}  // namespace
}  // namespace pneuma::sim
