// Inside or outside by counting crossings, against the winding number; the way out, by brute force.
#include "sim/collision/point_in_body.h"

#include <gtest/gtest.h>

#include <numbers>

#include "sim/mesh/primitives.h"
#include "tests/sim/collision/feature_samples.h"
#include "tests/sim/collision/surface_body.h"
#include "tests/sim/collision/uniform.h"

namespace pneuma::sim {
namespace {

/// How often the surface winds around the point: the solid angles of its triangles over 4 pi, by
/// Van Oosterom and Strackee's formula. 1 inside, 0 outside, and neither on the surface.
double winding_number(const SurfaceBody& body, const Vec3& point) {
  double half_angles = 0.0;
  for (const Triangle& t : body.topology.triangles()) {
    const Vec3 a = body.positions[t[0]] - point;
    const Vec3 b = body.positions[t[1]] - point;
    const Vec3 c = body.positions[t[2]] - point;
    const double volume = a.dot(b.cross(c));
    const double lengths = a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                           b.dot(c) * a.norm() + c.dot(a) * b.norm();
    half_angles += std::atan2(volume, lengths);
  }
  return half_angles / (2.0 * std::numbers::pi);
}

/// The paper's torus, dented and wrung: z over x, y is many-valued and no face is vertical or flat.
SurfaceBody deformed_torus() {
  SurfaceBody body(make_torus(4.0, 1.5, 16, 16));
  Uniform uniform(2);
  for (int i = 0; i < body.positions.size(); ++i) {
    const Vec3 p = body.positions[i];
    const Vec3 noise{uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(-0.1, 0.1)};
    body.positions[i] = p + noise + Vec3(0.3 * std::sin(p.z()), 0.0, std::sin(0.8 * p.x()));
  }
  return body;
}

double distance_to_surface(const SurfaceBody& body, const Vec3& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int t = 0; t < body.topology.triangle_count(); ++t) {
    nearest =
        std::min(nearest, reference_distance(Points{point}, triangle_corners(body.surface(), t)));
  }
  return nearest;
}

// What is_inside promises: 8 units in the last place of coordinates below 8.
constexpr double rounding_of_surface = 8 * 0x1p-50;

struct Tally {
  int inside = 0;
  int outside = 0;
  int on_surface = 0;
};

TriangleColumns columns_of(const SurfaceBody& body) {
  TriangleColumns columns;
  columns.fill(body.surface());
  return columns;
}

/// Compares is_inside with the winding number at one point. On the surface both may say anything,
/// but there is a way out of just what is_inside says is inside.
void compare(const SurfaceBody& body, const TriangleColumns& columns, const Vec3& point,
             Tally& tally) {
  ASSERT_EQ(find_surface_exit(body.surface(), columns, point).has_value(),
            is_inside(body.surface(), point))
      << point.transpose();
  const bool inside = winding_number(body, point) > 0.5;
  if (is_inside(body.surface(), point) == inside) {
    ++(inside ? tally.inside : tally.outside);
    return;
  }
  ++tally.on_surface;
  ASSERT_LE(distance_to_surface(body, point), rounding_of_surface) << point.transpose();
}

TEST(PointInBody, AgreesWithTheWindingNumberInAndAroundATorus) {
  const SurfaceBody torus = deformed_torus();
  const TriangleColumns columns = columns_of(torus);
  const Bounds around = bounds(torus.positions);
  Uniform uniform(3);
  Tally tally;
  for (int i = 0; i < 50'000; ++i) {
    Vec3 point;
    for (int k = 0; k < 3; ++k) point[k] = uniform(around.low[k] - 0.5, around.high[k] + 0.5);
    compare(torus, columns, point, tally);
  }
  EXPECT_GT(tally.inside, 5'000);
  EXPECT_GT(tally.outside, 5'000);
  EXPECT_EQ(tally.on_surface, 0);
}

/// Coordinates rounded to 1/64: sums and midpoints of them are exact, so that points can be put
/// exactly below a vertex or an edge, and many vertices share an x or a y.
void snap(SurfaceBody& body) {
  for (int i = 0; i < body.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      body.positions[i][k] = std::round(body.positions[i][k] * 64.0) / 64.0;
  }
}

// Rays that pass exactly through vertices and edges (ERRATA row 17).
TEST(PointInBody, AgreesStraightBelowAndAboveVerticesAndEdges) {
  SurfaceBody torus = deformed_torus();
  snap(torus);
  const TriangleColumns columns = columns_of(torus);
  const Bounds around = bounds(torus.positions);
  Uniform uniform(4);
  Tally tally;
  for (int i = 0; i < 50'000; ++i) {
    const auto& [a, b] = torus.topology.edges()[at(uniform.below(torus.topology.edge_count()))];
    Vec3 point = torus.positions[a];
    if (i % 3 == 1) point = 0.5 * (torus.positions[a] + torus.positions[b]);
    if (i % 3 == 2) point.y() = torus.positions[b].y();  // in line with two vertices
    point.z() = uniform(around.low.z() - 0.5, around.high.z() + 0.5);
    compare(torus, columns, point, tally);
  }
  EXPECT_GT(tally.inside, 5'000);
  EXPECT_GT(tally.outside, 5'000);
  EXPECT_LT(tally.on_surface, 100);  // below the middle of an edge that is vertical
}

// Rays that pass an edge within rounding: wherever such a point is put beside the edge, the two
// triangles there must agree on it.
TEST(PointInBody, AgreesWithinRoundingOfVerticesAndEdgesSeenFromBelow) {
  const SurfaceBody torus = deformed_torus();
  const TriangleColumns columns = columns_of(torus);
  const Bounds around = bounds(torus.positions);
  Uniform uniform(8);
  Tally tally;
  for (int i = 0; i < 50'000; ++i) {
    const auto& [a, b] = torus.topology.edges()[at(uniform.below(torus.topology.edge_count()))];
    const double along = i % 2 == 0 ? uniform(0.0, 1.0) : 0.0;
    Vec3 point = torus.positions[a] + along * (torus.positions[b] - torus.positions[a]);
    for (int k = 0; k < 2; ++k) {
      for (int n = uniform.below(3); n > 0; --n) point[k] = std::nextafter(point[k], -10.0);
    }
    point.z() = uniform(around.low.z() - 0.5, around.high.z() + 0.5);
    compare(torus, columns, point, tally);
  }
  EXPECT_GT(tally.inside, 5'000);
  EXPECT_GT(tally.outside, 5'000);
  EXPECT_EQ(tally.on_surface, 0);
}

// Vertical and horizontal faces, with rays that run along them. Where the truth is plain: inside up
// to 1 in every coordinate.
TEST(PointInBody, IsRightOnAGridThroughABox) {
  const SurfaceBody box(make_box({2.0, 2.0, 2.0}, 4));  // vertices at multiples of 1/2
  for (int x = -10; x <= 10; ++x) {
    for (int y = -10; y <= 10; ++y) {
      for (int z = -10; z <= 10; ++z) {
        const Vec3 point = Vec3(x, y, z) / 8.0;
        const double size = point.cwiseAbs().maxCoeff();
        if (size == 1.0) continue;  // on the surface
        EXPECT_EQ(is_inside(box.surface(), point), size < 1.0) << point.transpose();
      }
    }
  }
}

// Just beside a face the side is known without any reference.
TEST(PointInBody, IsRightDownToRoundingOfTheSurface) {
  const SurfaceBody torus = deformed_torus();
  Uniform uniform(5);
  for (int i = 0; i < 100'000; ++i) {
    const int t = uniform.below(torus.topology.triangle_count());
    const Corners corners = triangle_corners(torus.surface(), t);
    const double u = uniform(0.1, 0.45);
    const double v = uniform(0.1, 0.45);
    const Vec3 on_face = (1.0 - u - v) * corners[0] + u * corners[1] + v * corners[2];
    const Vec3 normal = feature_normal(torus.surface(), {FeatureKind::triangle, t});
    const double gap = std::pow(10.0, uniform(-5.0, 0.0)) * 1e-9 + rounding_of_surface;
    ASSERT_TRUE(is_inside(torus.surface(), on_face - gap * normal)) << gap;
    ASSERT_FALSE(is_inside(torus.surface(), on_face + gap * normal)) << gap;
  }
}

TEST(SurfaceExit, IsTheNearestPointOfTheSurface) {
  const SurfaceBody torus = deformed_torus();
  const TriangleColumns columns = columns_of(torus);
  const Bounds around = bounds(torus.positions);
  Uniform uniform(6);
  int exits = 0;
  int at_edges = 0;
  for (int i = 0; i < 6'000; ++i) {
    Vec3 point;
    for (int k = 0; k < 3; ++k) point[k] = uniform(around.low[k] - 0.5, around.high[k] + 0.5);
    const auto exit = find_surface_exit(torus.surface(), columns, point);
    ASSERT_EQ(exit.has_value(), is_inside(torus.surface(), point));
    if (!exit) continue;
    ++exits;
    double nearest = std::numeric_limits<double>::infinity();
    std::vector<double> distances;
    for (int t = 0; t < torus.topology.triangle_count(); ++t) {
      const Corners corners = triangle_corners(torus.surface(), t);
      distances.push_back(reference_distance(Points{point}, corners));
      nearest = std::min(nearest, distances.back());
    }
    // Some roundings of coordinates below 7.
    ASSERT_NEAR(exit->depth, nearest, 1e-14);
    ASSERT_NEAR((exit->point - point).norm(), nearest, 1e-14);
    // Of the triangles that are as near the one that faces the point most squarely, and that one
    // always faces it.
    const auto facing = [&](int t) {
      return (exit->point - point).dot(feature_normal(torus.surface(), {FeatureKind::triangle, t}));
    };
    ASSERT_GT(facing(exit->triangle), 0.0);
    int as_near = 0;
    for (int t = 0; t < torus.topology.triangle_count(); ++t) {
      if (distances[at(t)] > nearest + 1e-14) continue;
      ++as_near;
      ASSERT_LE(facing(t), facing(exit->triangle) + 1e-13);
    }
    if (as_near > 1) ++at_edges;
    ASSERT_EQ(exit->normal,
              feature_normal(torus.surface(), {FeatureKind::triangle, exit->triangle}));
  }
  EXPECT_GT(exits, 500);
  EXPECT_GT(at_edges, 20);
}

// All vertices in one plane, or in one point: nothing is inside, and nothing breaks.
TEST(SurfaceExit, IsNoneInABodyWithoutVolume) {
  SurfaceBody box(make_box({2.0, 2.0, 2.0}, 2));
  for (int i = 0; i < box.positions.size(); ++i) box.positions[i].z() = 0.0;
  EXPECT_FALSE(find_surface_exit(box.surface(), columns_of(box), Vec3(0.1, 0.2, 0.0)));
  for (int i = 0; i < box.positions.size(); ++i) box.positions[i].setZero();
  EXPECT_FALSE(find_surface_exit(box.surface(), columns_of(box), Vec3::Zero()));
}

}  // namespace
}  // namespace pneuma::sim
