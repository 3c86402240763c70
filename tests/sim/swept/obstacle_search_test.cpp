// What a soft body may touch of an obstacle: against looking at every pair of features.
#include "sim/swept/obstacle_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/mesh/primitives.h"
#include "sim/mesh/soft_mesh.h"
#include "sim/swept/feature_ways.h"

namespace pneuma::sim {
namespace {

constexpr double near = 0.01;    // m
constexpr double least = 0.001;  // m

MovingSurface make_surface(const SoftMesh& mesh, const Vec3& offset) {
  MovingSurface surface;
  surface.tree = std::make_shared<SurfaceTree>(mesh.topology, mesh.rest_positions, false);
  surface.start = mesh.rest_positions;
  for (int v = 0; v < surface.start.size(); ++v) surface.start[v] += offset;
  surface.end = surface.start;
  return surface;
}

/// With hills, hollows and saddles.
TriangleMesh make_bumpy_ball(int subdivisions) {
  TriangleMesh mesh = make_icosphere(2.0, subdivisions);
  for (Vec3& x : mesh.vertices) {
    x *= 1.0 + 0.1 * std::sin(5.0 * x.x()) * std::cos(4.0 * x.y()) * std::sin(4.0 * x.z() + 0.5);
  }
  return mesh;
}

/// After which fraction of the step a pair comes near; 1 if it does not.
double time_of(const MovingSurface& soft, const MovingSurface& obstacle,
               const NearFeatures& features) {
  const double change = greatest_change(soft, obstacle, features);
  const auto closest = closest_points(soft, obstacle, features, Moment::start, change + least);
  if (!closest) return 1.0;
  return time_of_meeting(soft, obstacle, features, closest->distance, 0.5 * least).value_or(1.0);
}

double first_of_all(const MovingSurface& soft, const MovingSurface& obstacle) {
  const MeshTopology &a = soft.tree->topology(), &b = obstacle.tree->topology();
  double first = 1.0;
  const auto look = [&](FeatureKind of_a, int count_a, FeatureKind of_b, int count_b) {
    for (int i = 0; i < count_a; ++i) {
      for (int j = 0; j < count_b; ++j) {
        first = std::min(first, time_of(soft, obstacle, {{of_a, i}, {of_b, j}}));
      }
    }
  };
  look(FeatureKind::vertex, a.vertex_count(), FeatureKind::triangle, b.triangle_count());
  look(FeatureKind::triangle, a.triangle_count(), FeatureKind::vertex, b.vertex_count());
  look(FeatureKind::edge, a.edge_count(), FeatureKind::edge, b.edge_count());
  return first;
}

/// Above the highest point of the obstacle beneath, and moved down.
MovingSurface make_falling_ball(const SoftMesh& mesh, const MovingSurface& obstacle,
                                std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Vec3 side(0.6 * uniform(random), 0.6 * uniform(random), 0.0);
  MovingSurface ball = make_surface(mesh, side + Vec3(0.0, 0.0, 4.0));
  double fall = 4.0;  // until something is nearest
  for (int v = 0; v < obstacle.start.size(); ++v) {
    for (int w = 0; w < ball.start.size(); ++w) {
      const Vec3 apart = ball.start[w] - obstacle.start[v];
      if (apart.head<2>().norm() < 0.5) fall = std::min(fall, apart.z());
    }
  }
  const Vec3 way(0.1 * uniform(random), 0.1 * uniform(random), -0.3);
  for (int v = 0; v < ball.start.size(); ++v) {
    ball.start[v].z() -= fall - 0.05;
    const Vec3 own(uniform(random), uniform(random), uniform(random));
    ball.end[v] = ball.start[v] + way + 0.05 * own;
  }
  return ball;
}

TEST(ObstacleSearch, FindsWhatMeetsFirst) {
  const auto of_ball = make_soft_mesh(make_icosphere(0.7, 1));
  const auto of_obstacle = make_soft_mesh(make_bumpy_ball(3));
  std::mt19937 random(7);
  ObstacleSearch search;
  int met = 0;
  for (int i = 0; i < 30; ++i) {
    const bool is_still = i % 2 == 0;
    MovingSurface obstacle = make_surface(*of_obstacle, Vec3::Zero());
    const MovingSurface ball = make_falling_ball(*of_ball, obstacle, random);
    if (!is_still) {
      for (int v = 0; v < obstacle.end.size(); ++v) obstacle.end[v] += Vec3(0.02, -0.03, 0.05);
    }
    refit(obstacle, near);
    ObstacleShape shape(of_obstacle->topology, of_obstacle->rest_positions);
    if (is_still) shape.keep_place(obstacle);
    std::vector<NearFeatures> found;
    search.find_first_to_pass({ball, obstacle, shape, true, near, least}, found);
    double first = 1.0;
    for (const NearFeatures& one : found) first = std::min(first, time_of(ball, obstacle, one));
    const double of_all = first_of_all(ball, obstacle);
    EXPECT_LE(first, of_all + 1e-3) << i;
    met += of_all < 1.0 ? 1 : 0;
  }
  EXPECT_GT(met, 15);
}

/// The sphere of 20,480 triangles has 16 times as many as the other.
TEST(ObstacleSearch, FindsLittleMoreOfAFinerObstacle) {
  const auto of_ball = make_soft_mesh(make_icosphere(1.0, 2));
  ObstacleSearch search;
  std::vector<std::size_t> counts;
  for (const int subdivisions : {3, 5}) {
    const auto of_obstacle = make_soft_mesh(make_icosphere(4.0, subdivisions));
    MovingSurface obstacle = make_surface(*of_obstacle, Vec3::Zero());
    refit(obstacle, near);
    ObstacleShape shape(of_obstacle->topology, of_obstacle->rest_positions);
    shape.keep_place(obstacle);
    MovingSurface ball = make_surface(*of_ball, {0.1, 0.2, 5.0});
    for (int v = 0; v < ball.end.size(); ++v) ball.end[v].z() += 0.02;
    std::vector<NearFeatures> found;
    search.find_first_to_pass({ball, obstacle, shape, true, near, least}, found);
    counts.push_back(found.size());
    refit(ball, near);
    std::vector<NearFeatures> all;
    find_near_features(ball, obstacle, all);
    if (subdivisions == 5) {
      EXPECT_LT(4 * found.size(), all.size());
    }
  }
  EXPECT_LT(counts[1], 3 * counts[0] + 50);
}

TEST(ObstacleShape, IsTouchedFirstWhereItIsConvex) {
  const auto box = make_soft_mesh(make_box({2.0, 2.0, 2.0}, 4));
  const ObstacleShape of_box(box->topology, box->rest_positions);
  const auto sides = [&](int v) {  // of the box on which a vertex lies
    return (box->rest_positions[v].cwiseAbs().array() > 1.0 - 1e-9).count();
  };
  for (int v = 0; v < box->topology.vertex_count(); ++v) {
    EXPECT_EQ(of_box.is_touchable_vertex(v), sides(v) > 1) << v;
  }
  for (int e = 0; e < box->topology.edge_count(); ++e) {
    const auto& [from, to] = box->topology.edges()[at(e)];
    const auto& [one, other] = box->topology.edge_triangles()[at(e)];
    const auto normal = [&](int t) {
      const auto& [a, b, c] = box->topology.triangles()[at(t)];
      const auto& x = box->rest_positions;
      return Vec3(Vec3(x[b] - x[a]).cross(Vec3(x[c] - x[a])).normalized());
    };
    EXPECT_EQ(of_box.is_touchable_edge(e), normal(one).dot(normal(other)) < 0.5)
        << from << ' ' << to;
  }
  const auto torus = make_soft_mesh(make_torus(2.0, 0.5, 24, 16));
  const ObstacleShape of_torus(torus->topology, torus->rest_positions);
  for (int v = 0; v < torus->topology.vertex_count(); ++v) {
    const double radius = torus->rest_positions[v].head<2>().norm();
    if (std::abs(radius - 2.0) < 0.1) continue;  // between hill and saddle
    EXPECT_EQ(of_torus.is_touchable_vertex(v), radius > 2.0) << v;
  }
}

}  // namespace
}  // namespace pneuma::sim
