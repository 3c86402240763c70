#include "sim/base/exact.h"

#include <gtest/gtest.h>

namespace pneuma::base {
namespace {

constexpr std::int64_t far = grid_steps;

TEST(Exact, SideOfAPlaneAtFullRange) {
  // The plane x + y + z = 2^30, and points one step off it: doubles lose that step.
  const GridPoint a = {far, 0, 0}, b = {0, far, 0}, c = {0, 0, far};
  const std::int64_t third = far / 3;
  const GridPoint on = {third, third, far - 2 * third};
  EXPECT_EQ(side_of_plane(a, b, c, on), 0);
  EXPECT_EQ(side_of_plane(a, b, c, {on[0], on[1], on[2] + 1}),
            -side_of_plane(a, b, c, {on[0], on[1], on[2] - 1}));
  EXPECT_NE(side_of_plane(a, b, c, {on[0], on[1], on[2] + 1}), 0);
}

TEST(Exact, SideIsThatOfClockwiseTriangles) {
  const GridPoint a = {0, 0, 0}, b = {1, 0, 0}, c = {0, 1, 0};
  EXPECT_EQ(side_of_plane(a, b, c, {0, 0, 5}), -1);  // from above it runs counter-clockwise
  EXPECT_EQ(side_of_plane(a, b, c, {0, 0, -5}), 1);
}

TEST(Exact, PointsOnOneLine) {
  EXPECT_TRUE(on_one_line({0, 0, 0}, {far / 2, far / 2, far / 2}, {far, far, far}));
  EXPECT_FALSE(on_one_line({0, 0, 0}, {far / 2, far / 2, far / 2 + 1}, {far, far, far}));
}

struct SegmentCase {
  const char* what;
  GridPoint p, q;
  bool meets;
};

// Against the triangle (0 0 0) (4 0 0) (0 4 0).
const SegmentCase segments[] = {
    {"through the inside", {1, 1, -1}, {1, 1, 1}, true},
    {"past it", {3, 3, -1}, {3, 3, 1}, false},
    {"ends on the inside", {1, 1, 0}, {1, 1, 7}, true},
    {"ends one above the inside", {1, 1, 1}, {1, 1, 7}, false},
    {"through a side", {2, 2, -1}, {2, 2, 1}, true},
    {"through a corner", {4, 0, -1}, {4, 0, 1}, true},
    {"through a side's extension", {5, 0, -1}, {5, 0, 1}, false},
    {"in the plane, across", {-1, 1, 0}, {5, 1, 0}, true},
    {"in the plane, within", {1, 1, 0}, {2, 1, 0}, true},
    {"in the plane, apart", {3, 3, 0}, {5, 1, 0}, false},
    {"in the plane, along a side", {1, 0, 0}, {3, 0, 0}, true},
    {"in the plane, along a side's extension", {5, 0, 0}, {7, 0, 0}, false},
    {"in the plane, touches a corner", {4, 0, 0}, {6, 6, 0}, true},
    {"parallel above", {-1, 1, 1}, {5, 1, 1}, false},
};

TEST(Exact, SegmentsAndATriangleInEveryAxisOrder) {
  const GridPoint a = {0, 0, 0}, b = {4, 0, 0}, c = {0, 4, 0};
  for (const auto& [what, p, q, meets] : segments) {
    for (std::size_t turn = 0; turn < 3; ++turn) {
      const auto turned = [&](const GridPoint& g) {
        return GridPoint{g[turn], g[(turn + 1) % 3], g[(turn + 2) % 3]};
      };
      EXPECT_EQ(segment_meets_triangle(turned(p), turned(q), turned(a), turned(b), turned(c)),
                meets)
          << what << ", turn " << turn;
      EXPECT_EQ(segment_meets_triangle(turned(q), turned(p), turned(c), turned(b), turned(a)),
                meets)
          << what << " backwards, turn " << turn;
    }
  }
}

TEST(Exact, SameSideOfAnEdge) {
  const GridPoint a = {0, 0, 0}, b = {4, 0, 0}, c = {0, 4, 0};
  EXPECT_TRUE(same_side_of_edge(a, b, c, {9, 1, 0}));
  EXPECT_FALSE(same_side_of_edge(a, b, c, {9, 0, 0}));
  EXPECT_FALSE(same_side_of_edge(a, b, c, {9, -1, 0}));
}

}  // namespace
}  // namespace pneuma::base
