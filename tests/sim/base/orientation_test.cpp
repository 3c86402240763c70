#include "sim/base/orientation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "sim/base/exact.h"

namespace pneuma::base {
namespace {

__extension__ using Wide = __int128;

Point to_double(const GridPoint& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// The determinant in integers of 128 bits: exact for coordinates up to 2^40.
int wide_side(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  Wide m[3][3];
  for (std::size_t k = 0; k < 3; ++k) {
    m[0][k] = b[k] - a[k];
    m[1][k] = c[k] - a[k];
    m[2][k] = d[k] - a[k];
  }
  const Wide det = m[2][0] * (m[0][1] * m[1][2] - m[0][2] * m[1][1]) +
                   m[2][1] * (m[0][2] * m[1][0] - m[0][0] * m[1][2]) +
                   m[2][2] * (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
  return det > 0 ? -1 : det < 0 ? 1 : 0;
}

/// Of points given by their numbers.
int side(const Point& a, const Point& b, const Point& c, const Point& d) {
  return side_of_plane(a, b, c, d);
}

class RandomGrid {
 public:
  explicit RandomGrid(unsigned seed) : random_(seed) {}
  std::int64_t number(std::int64_t size) {
    return std::uniform_int_distribution<std::int64_t>(-size, size)(random_);
  }
  GridPoint point(std::int64_t size) { return {number(size), number(size), number(size)}; }

 private:
  std::mt19937_64 random_;
};

TEST(Orientation, AgreesWithIntegersWhereverPointsLie) {
  RandomGrid random(1);
  for (const std::int64_t size : {std::int64_t{2}, std::int64_t{1} << 20, grid_steps}) {
    for (int i = 0; i < 20000; ++i) {
      const GridPoint a = random.point(size), b = random.point(size), c = random.point(size),
                      d = random.point(size);
      ASSERT_EQ(side_of_plane(to_double(a), to_double(b), to_double(c), to_double(d)),
                side_of_plane(a, b, c, d));
    }
  }
}

TEST(Orientation, AgreesWithIntegersNextToThePlane) {
  // d = a + m (b - a) + n (c - a), on the plane, and up to one step off it. The coordinates have
  // 40 bits, the determinants about 80: doubles without the exact part err in every fortieth case.
  RandomGrid random(2);
  int on_plane = 0, wrong_in_doubles = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t size = std::int64_t{1} << 36;
    const GridPoint a = random.point(size), b = random.point(size), c = random.point(size);
    const std::int64_t m = random.number(3), n = random.number(3);
    GridPoint d;
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = a[k] + m * (b[k] - a[k]) + n * (c[k] - a[k]) + random.number(1);
    }
    const int expected = wide_side(a, b, c, d);
    const Point x = to_double(a), y = to_double(b), z = to_double(c), w = to_double(d);
    ASSERT_EQ(side_of_plane(x, y, z, w), expected);
    ASSERT_EQ(side_of_plane(y, x, z, w), -expected);
    on_plane += expected == 0;
    const auto cross = [&](std::size_t j, std::size_t k) {
      return (y[j] - x[j]) * (z[k] - x[k]) - (y[k] - x[k]) * (z[j] - x[j]);
    };
    const double rounded =
        -((w[0] - x[0]) * cross(1, 2) + (w[1] - x[1]) * cross(2, 0) + (w[2] - x[2]) * cross(0, 1));
    wrong_in_doubles += (rounded > 0.0) - (rounded < 0.0) != expected;
  }
  EXPECT_GT(on_plane, 500);
  EXPECT_GT(wrong_in_doubles, 200) << "or the cases are no test";
}

TEST(Orientation, SeesOneUnitInTheLastPlaceOfCoordinatesOfDifferentSize) {
  // Differences of these points are not doubles: the plane x + y + z = 1 far from its corners.
  const Point a = {1.0, 0.0, 0.0}, b = {0.0, 1.0, 0.0}, c = {0.0, 0.0, 1.0};
  constexpr double tiny = 0x1p-200;
  EXPECT_EQ(side(a, b, c, {0.5, 0.5, 0.0}), 0);
  EXPECT_EQ(side(a, b, c, {0.5, 0.5, tiny}), -1);
  EXPECT_EQ(side(a, b, c, {0.5, 0.5, -tiny}), 1);
  EXPECT_EQ(side(a, b, c, {0x1p60, -0x1p60, 1.0}), 0);
  EXPECT_EQ(side(a, b, c, {0x1p60, -0x1p60, 1.0 + 0x1p-52}), -1);
}

TEST(Orientation, OfWhatIsNotFiniteIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_EQ(side({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, bad}), 0);
    EXPECT_EQ(side({bad, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 0);
  }
}

int direction(const GridPoint& p, const GridPoint& q, const GridPoint& a, const GridPoint& b,
              const GridPoint& c) {
  return find_passage(to_double(p), to_double(q), to_double(a), to_double(b), to_double(c))
      .direction;
}

TEST(Passage, IsFromOneSideStrictlyToTheOther) {
  const GridPoint a = {0, 0, 0}, b = {4, 0, 0}, c = {0, 4, 0};
  EXPECT_EQ(direction({1, 1, -1}, {1, 1, 1}, a, b, c), 1);
  EXPECT_EQ(direction({1, 1, 1}, {1, 1, -1}, a, b, c), -1);
  EXPECT_EQ(direction({1, 1, 0}, {1, 1, 1}, a, b, c), 0) << "ends on it";
  EXPECT_EQ(direction({-1, 1, 0}, {5, 1, 0}, a, b, c), 0) << "in its plane";
  EXPECT_EQ(direction({3, 3, -1}, {3, 3, 1}, a, b, c), 0) << "past it";
  EXPECT_TRUE(find_passage({-1, 1, 0}, {5, 1, 0}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}).in_plane);
  EXPECT_FALSE(find_passage({1, 1, 0}, {1, 1, 1}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}).in_plane);
}

TEST(Passage, OfSegmentsInsideAgreesWithTheGrid) {
  // Where nothing is met on a side, at a corner or by an end, meeting and passing are the same.
  RandomGrid random(3);
  int passages = 0;
  for (int i = 0; i < 50000; ++i) {
    const GridPoint p = random.point(9), q = random.point(9), a = random.point(9),
                    b = random.point(9), c = random.point(9);
    const int sides[] = {side_of_plane(a, b, c, p), side_of_plane(a, b, c, q),
                         side_of_plane(p, q, a, b), side_of_plane(p, q, b, c),
                         side_of_plane(p, q, c, a)};
    if (std::count(std::begin(sides), std::end(sides), 0) > 0) continue;
    const bool meets = segment_meets_triangle(p, q, a, b, c);
    ASSERT_EQ(direction(p, q, a, b, c), meets ? sides[0] : 0);
    passages += meets;
  }
  EXPECT_GT(passages, 1000);
}

TEST(Passage, ThroughAClosedSurfaceSumsUpOverItsTriangles) {
  // A tetrahedron of small integers and segments between grid points outside it, most of which meet
  // edges or vertices of it. Whatever goes in comes out: the directions of all triangles sum up to
  // 0. From the grid point inside, exactly one triangle more is passed outwards.
  const GridPoint corners[] = {{-4, -4, -4}, {4, 4, -4}, {4, -4, 4}, {-4, 4, 4}};
  const int triangles[][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  const GridPoint inside = {0, 0, 0};
  const auto sum = [&](const GridPoint& p, const GridPoint& q) {
    int directions = 0;
    for (const auto& [a, b, c] : triangles) {
      directions += direction(p, q, corners[a], corners[b], corners[c]);
    }
    return directions;
  };
  const int out = sum(inside, {100, 37, 11});
  EXPECT_EQ(std::abs(out), 1);
  RandomGrid random(4);
  for (int i = 0; i < 5000; ++i) {
    GridPoint p = random.point(3), q = random.point(3);
    if (p == inside || q == inside) continue;
    for (std::size_t k = 0; k < 3; ++k) p[k] *= 16, q[k] *= 16;
    EXPECT_EQ(sum(inside, p), out) << p[0] << ' ' << p[1] << ' ' << p[2];
    EXPECT_EQ(sum(p, q), 0);
  }
}

}  // namespace
}  // namespace pneuma::base
