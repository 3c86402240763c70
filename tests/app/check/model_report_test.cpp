#include "app/check/model_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/check/check_model.h"
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

/// A ball with a pole of so many triangles at either end.
sim::TriangleMesh ball_with_poles(int slices) { return sim::make_sphere(1.0, 8, slices); }

TEST(ModelReport, FindsTheVertexWithTheMostSprings) {
  const ModelReport report = report_of(ball_with_poles(40));
  EXPECT_EQ(report.most_springs, 40);
  EXPECT_NEAR(std::abs(report.most_springs_at.z()), 1.0, 1e-12);
}

TEST(ManySteps, NameTheirCause) {
  EXPECT_EQ(many_steps_text(report_of(ball_with_poles(40)), 5000), "");
  const std::string of_poles = many_steps_text(report_of(ball_with_poles(40)), 29'190);
  EXPECT_NE(
      of_poles.find("29,190 per second are many: because of the 40 springs at the vertex (0, 0, "),
      std::string::npos)
      << of_poles;
  const std::string of_all = many_steps_text(report_of(sim::make_icosphere(1.0, 2)), 6000);
  EXPECT_NE(of_all.find("because of 162 vertices"), std::string::npos) << of_all;
}

}  // namespace
}  // namespace pneuma::app
