// Simplified models: what stays of the surface, judged by searches through all triangles.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "assets/clean_mesh.h"
#include "assets/simplify/simplify_mesh.h"
#include "sim/inspect/crossings.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/mesh/soft_mesh.h"
#include "tests/assets/model_writers.h"

namespace pneuma::assets {
namespace {

using sim::at;
using sim::TriangleMesh;

/// Bumps and dents of a few edges of the coarse mesh across.
TriangleMesh bumpy_ball() {
  TriangleMesh mesh = sim::make_icosphere(1.0, 4);
  for (Vec3& v : mesh.vertices) {
    v *= 1.0 + 0.15 * std::sin(5.0 * v.x() + 1.0) * std::sin(4.0 * v.y()) * std::cos(6.0 * v.z());
  }
  return mesh;
}

/// A ring of a square bar with sharp edges, thinner than its wanted edges are long.
TriangleMesh flat_ring() {
  TriangleMesh mesh = sim::make_torus(2.0, 0.6, 60, 24);
  for (Vec3& v : mesh.vertices) v.z() *= 0.05;
  return mesh;
}

TriangleMesh fine_box() { return sim::make_box({1.0, 2.0, 0.7}, 15); }

/// Two sheets, nearer to each other than any edge is long.
TriangleMesh folded_sheet() {
  TriangleMesh mesh = sim::make_box({4.0, 2.0, 0.05}, 18);
  for (Vec3& v : mesh.vertices) {  // bent around an axis by most of a turn
    const double angle = 0.75 * v.x() * std::numbers::pi / 2.0, radius = 0.12 + v.z();
    const double along = 0.08 * v.x() * v.x();
    v = {(radius + along) * std::cos(angle), -v.y(), (radius + along) * std::sin(angle)};
  }
  return mesh;
}

double volume_in(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += mesh.vertices[at(a)].dot(mesh.vertices[at(b)].cross(mesh.vertices[at(c)])) / 6.0;
  }
  return sum;
}

double whole_area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum +=
        sim::area_vector(mesh.vertices[at(a)], mesh.vertices[at(b)], mesh.vertices[at(c)]).norm();
  }
  return sum;
}

double squared_distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + s * (b - a) - p).squaredNorm();
}

/// To the plane where the foot lies within the triangle, else to the sides.
double distance(const Vec3& p, const TriangleMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 &a = mesh.vertices[at(i)], &b = mesh.vertices[at(j)], &c = mesh.vertices[at(k)];
    const Vec3 normal = (b - a).cross(c - a);
    const bool inside = (b - a).cross(p - a).dot(normal) >= 0.0 &&
                        (c - b).cross(p - b).dot(normal) >= 0.0 &&
                        (a - c).cross(p - c).dot(normal) >= 0.0;
    const double height = (p - a).dot(normal) / normal.norm();
    least =
        std::min({least, squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                  squared_distance_to_segment(p, c, a), inside ? height * height : least});
  }
  return std::sqrt(least);
}

double farthest(const std::vector<Vec3>& points, const TriangleMesh& mesh) {
  double most = 0.0;
  for (const Vec3& point : points) most = std::max(most, distance(point, mesh));
  return most;
}

std::vector<double> angles(const TriangleMesh& mesh) {
  std::vector<double> result;
  for (const Triangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& corner = mesh.vertices[at(triangle[i])];
      const Vec3 one = mesh.vertices[at(triangle[(i + 1) % 3])] - corner;
      const Vec3 other = mesh.vertices[at(triangle[(i + 2) % 3])] - corner;
      result.push_back(std::atan2(one.cross(other).norm(), one.dot(other)) * 180.0 /
                       std::numbers::pi);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

int crossing_edges(const TriangleMesh& mesh) {
  sim::World world;
  sim::SoftBody body;
  body.mesh = sim::make_soft_mesh(mesh);
  body.positions = body.mesh->rest_positions;
  body.velocities = sim::VertexArray(body.positions.size());
  world.soft.push_back(std::move(body));
  return sim::crossings(world).within_bodies;
}

struct Shape {
  const char* name;
  TriangleMesh (*make)();
  int vertices;  // to be simplified to
  int euler;
  double distance;   // in edges: corners and thin walls are blunted most
  double min_angle;  // degrees, of all but one in twenty; flat walls have none to choose from
};

class Simplified : public testing::TestWithParam<Shape> {
 protected:
  const TriangleMesh full_ = GetParam().make();
  const TriangleMesh coarse_ = simplify_mesh(full_, GetParam().vertices);
  /// Of equilateral triangles of the area.
  const double edge_ =
      std::sqrt(whole_area(full_) / (0.5 * std::numbers::sqrt3 * GetParam().vertices));
};

TEST_P(Simplified, IsAsCoarseAsAskedForAndOfTheSameGenus) {
  ASSERT_GT(full_.vertices.size(), 2 * at(GetParam().vertices));
  EXPECT_EQ(static_cast<int>(coarse_.vertices.size()), GetParam().vertices);
  // Throws of a surface that is open, not manifold or not oriented.
  const sim::MeshTopology topology(static_cast<int>(coarse_.vertices.size()), coarse_.triangles);
  EXPECT_EQ(topology.vertex_count() - topology.edge_count() + topology.triangle_count(),
            GetParam().euler);
}

TEST_P(Simplified, CrossesItselfNowhere) {
  EXPECT_EQ(crossing_edges(full_), 0);
  EXPECT_EQ(crossing_edges(coarse_), 0);
}

// Rounding of the places to 2^-30 of the extent is what is left.
TEST_P(Simplified, KeepsItsVolume) {
  EXPECT_NEAR(volume_in(coarse_), volume_in(full_), 1e-6 * volume_in(full_));
}

// Either way: no part of one is far from the other.
TEST_P(Simplified, StaysNearTheSurface) {
  EXPECT_LT(farthest(full_.vertices, coarse_), GetParam().distance * edge_);
  EXPECT_LT(farthest(coarse_.vertices, full_), GetParam().distance * edge_);
}

TEST_P(Simplified, HasTrianglesOfEvenShape) {
  const std::vector<double> sorted = angles(coarse_);
  EXPECT_GT(sorted[sorted.size() / 20], GetParam().min_angle);
}

TEST_P(Simplified, IsTheSameEachTime) {
  const TriangleMesh again = simplify_mesh(full_, GetParam().vertices);
  EXPECT_EQ(again.vertices, coarse_.vertices);
  EXPECT_EQ(again.triangles, coarse_.triangles);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Simplified,
                         testing::Values(Shape{"BumpyBall", bumpy_ball, 600, 2, 0.2, 25.0},
                                         Shape{"FlatRing", flat_ring, 300, 0, 0.3, 4.0},
                                         Shape{"Box", fine_box, 300, 2, 0.3, 18.0},
                                         Shape{"FoldedSheet", folded_sheet, 250, 2, 0.4, 4.0}),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(SimplifyMesh, ReturnsWhatIsCoarseEnoughToTheBit) {
  const TriangleMesh mesh = bumpy_ball();
  const TriangleMesh same = simplify_mesh(mesh, static_cast<int>(mesh.vertices.size()));
  EXPECT_EQ(same.vertices, mesh.vertices);
  EXPECT_EQ(same.triangles, mesh.triangles);
}

// Of a surface with handles there is more to a shape than a few vertices.
TEST(SimplifyMesh, StopsWhereTheGenusAsksForMore) {
  const TriangleMesh least = simplify_mesh(sim::make_torus(1.0, 0.4, 12, 12), 1);
  const sim::MeshTopology topology(static_cast<int>(least.vertices.size()), least.triangles);
  EXPECT_GE(topology.vertex_count(), 7);
  EXPECT_EQ(topology.vertex_count() - topology.edge_count() + topology.triangle_count(), 0);
}

TEST(CleanMesh, SimplifiesBeforeItPlaces) {
  CleanOptions options;
  options.simplify_to = 300;
  options.scale = 3.0;
  const CleanModel model = clean_mesh({bumpy_ball(), {}, {}, 0, {}}, options);
  EXPECT_EQ(model.mesh.vertices.size(), 300u);
  EXPECT_EQ(model.simplified, "2562 vertices simplified to 300");
  EXPECT_NEAR(volume_in(model.mesh), 27.0 * volume_in(bumpy_ball()), 1e-4);
  options.simplify_to = 2562;
  EXPECT_EQ(clean_mesh({bumpy_ball(), {}, {}, 0, {}}, options).simplified, "");
}

TEST(CleanMesh, RefusesWhatCannotBeSoCoarse) {
  CleanOptions options;
  options.simplify_to = 4;
  try {
    clean_mesh({sim::make_torus(1.0, 0.4, 12, 12), {}, {}, 0, {}}, options);
    FAIL() << "simplified";
  } catch (const SimplifyError& error) {
    EXPECT_NE(std::string(error.what()).find("144 vertices cannot be simplified to 4, but to "),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pneuma::assets
