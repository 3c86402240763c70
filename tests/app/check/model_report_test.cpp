#include "app/check/model_report.h"

#include <gtest/gtest.h>

#include <numbers>

#include "sim/mesh/primitives.h"
#include "tests/assets/model_writers.h"

namespace pneuma::app {
namespace {

ModelReport report_of(const sim::TriangleMesh& mesh) {
  return report_on(assets::clean_mesh({mesh, {}, {}, 0, {}}));
}

TEST(ModelReport, OfACube) {
  const ModelReport report = report_of(assets::cube_of_24());
  EXPECT_EQ(report.vertices_before, 24);
  EXPECT_EQ(report.vertices_welded, 8);
  EXPECT_EQ(report.vertices, 8);
  EXPECT_EQ(report.edges, 18);  // twelve sides and six diagonals
  EXPECT_EQ(report.triangles, 12);
  EXPECT_EQ(report.boundary_edges, 0);
  EXPECT_EQ(report.non_manifold_edges, 0);
  EXPECT_EQ(report.genus, 0);
  EXPECT_DOUBLE_EQ(report.volume, 8.0);
  EXPECT_DOUBLE_EQ(report.area, 24.0);
  EXPECT_EQ(report.size, sim::Vec3(2.0, 2.0, 2.0));
  EXPECT_DOUBLE_EQ(report.edge_5th, 2.0);
  EXPECT_DOUBLE_EQ(report.edge_median, 2.0);  // 12 of 18
  EXPECT_DOUBLE_EQ(report.edge_95th, 2.0 * std::numbers::sqrt2);
  EXPECT_NEAR(report.smallest_angle, 45.0, 1e-12);  // of atan2's rounding
  EXPECT_DOUBLE_EQ(report.springs_per_vertex, 4.5);
}

TEST(ModelReport, OfATorus) {
  const ModelReport report = report_of(sim::make_torus(5.0, 2.0, 16, 16));
  EXPECT_EQ(report.genus, 1);
  EXPECT_EQ(report.edges, 768);
  EXPECT_EQ(report.fewest_springs, 6);
  EXPECT_EQ(report.most_springs, 6);
  // Of the smooth torus 2 pi^2 R r^2 = 394.8; 16 chords of a circle take 2.6 % of its area, twice.
  EXPECT_NEAR(report.volume, 2.0 * std::numbers::pi * std::numbers::pi * 5.0 * 4.0, 0.06 * 395.0);
  EXPECT_LT(report.volume, 2.0 * std::numbers::pi * std::numbers::pi * 5.0 * 4.0);
}

}  // namespace
}  // namespace pneuma::app
