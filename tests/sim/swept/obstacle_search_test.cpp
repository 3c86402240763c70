// What a soft body may touch of an obstacle: against looking at every pair of features.
#include "sim/swept/obstacle_search.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "sim/mesh/primitives.h"
#include "sim/mesh/soft_mesh.h"
#include "sim/swept/feature_ways.h"
#include "sim/swept/obstacle_frame.h"

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

/// Turned by up to so much (rad), and moved by up to a quarter of it (m), about where it was.
ObstaclePlace make_place(double amount, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&] {
    const double z = uniform(random), y = uniform(random), x = uniform(random);
    return Vec3(x, y, z);
  };
  const Vec3 axis = draw().normalized(), moved = 0.25 * amount * draw();
  return {Eigen::AngleAxisd(amount * uniform(random), axis).toRotationMatrix(), moved};
}

void put(const ObstaclePlace& place, const VertexArray& own, VertexArray& positions) {
  for (int v = 0; v < own.size(); ++v) positions[v] = place * Vec3(own[v]);
}

double first_of(const MovingSurface& soft, const MovingSurface& obstacle,
                const std::vector<NearFeatures>& found) {
  double first = 1.0;
  for (const NearFeatures& one : found) first = std::min(first, time_of(soft, obstacle, one));
  return first;
}

std::vector<NearFeatures> find_first_to_pass(const BesideObstacle& pair) {
  ObstacleSearch search;
  std::vector<TrianglePair> triangles;
  search.find_near_triangles(pair, triangles);
  std::vector<NearFeatures> found;
  search.find_first_to_pass(pair, triangles, found);
  return found;
}

/// At rest, and moved from one place to another, in halves of the step.
TEST(ObstacleSearch, FindsWhatMeetsFirst) {
  const auto of_ball = make_soft_mesh(make_icosphere(0.7, 1));
  const auto of_obstacle = make_soft_mesh(make_bumpy_ball(3));
  const MovingSurface own = [&] {
    MovingSurface surface = make_surface(*of_obstacle, Vec3::Zero());
    refit(surface, near);
    return surface;
  }();
  ObstacleShape shape(of_obstacle->topology, of_obstacle->rest_positions);
  shape.keep_place(own);
  std::mt19937 random(7);
  int met = 0;
  for (int i = 0; i < 60; ++i) {
    MovingSurface obstacle = own;
    ObstacleFrame frame;
    if (i % 2 == 1) {
      const double from = i % 4 == 1 ? 0.0 : 0.5;
      const ObstaclePlace start = make_place(3.0, random);
      const ObstaclePlace turn = make_place(0.3, random);
      frame.set(start, {turn.axes * start.axes, start.origin + turn.origin}, from, from + 0.5);
      put(frame.start(), own.start, obstacle.start);
      put(frame.end(), own.start, obstacle.end);
    }
    const MovingSurface ball = make_falling_ball(*of_ball, obstacle, random);
    MovingSurface seen = ball;
    const double bow = frame.look_at(ball.start, ball.end, seen.start, seen.end);
    const std::vector<NearFeatures> found = find_first_to_pass(
        {seen, own, shape, true, frame.own_length(near) + bow, frame.own_length(least) + bow});
    const double first = first_of(ball, obstacle, found);
    const double of_all = first_of_all(ball, obstacle);
    EXPECT_LE(first, of_all + 1e-3) << i;
    met += of_all < 1.0 ? 1 : 0;
  }
  EXPECT_GT(met, 30);
}

/// Whether a pair comes within `near` at one of some moments.
bool comes_near(const MovingSurface& soft, const MovingSurface& obstacle,
                const NearFeatures& features) {
  if (are_apart(soft, obstacle, features, near + greatest_change(soft, obstacle, features))) {
    return false;
  }
  for (const double s : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    if (closest_points_at(soft, obstacle, features, s).distance < near) return true;
  }
  return false;
}

/// Of the triangles that vertices and edges belong to, all whose features come near.
std::set<std::pair<int, int>> near_triangles(const MovingSurface& soft,
                                             const MovingSurface& obstacle) {
  const SurfaceTree &a = *soft.tree, &b = *obstacle.tree;
  std::set<std::pair<int, int>> near_ones;
  for (int v = 0; v < a.topology().vertex_count(); ++v) {
    for (int t = 0; t < b.topology().triangle_count(); ++t) {
      if (comes_near(soft, obstacle, {{FeatureKind::vertex, v}, {FeatureKind::triangle, t}})) {
        near_ones.emplace(a.owner_of_vertex(v), t);
      }
    }
  }
  for (int e = 0; e < a.topology().edge_count(); ++e) {
    for (int f = 0; f < b.topology().edge_count(); ++f) {
      if (comes_near(soft, obstacle, {{FeatureKind::edge, e}, {FeatureKind::edge, f}})) {
        near_ones.emplace(a.owner_of_edge(e), b.owner_of_edge(f));
      }
    }
  }
  return near_ones;
}

/// Also when the ball ends elsewhere by the allowance, as the obstacle is turned and moved.
TEST(ObstacleSearch, KnowsAllThatMayComeNear) {
  constexpr double allowance = 0.2;  // m
  const auto of_ball = make_soft_mesh(make_icosphere(0.7, 1));
  const auto of_obstacle = make_soft_mesh(make_bumpy_ball(3));
  MovingSurface own = make_surface(*of_obstacle, Vec3::Zero());
  refit(own, near);
  ObstacleShape shape(of_obstacle->topology, of_obstacle->rest_positions);
  shape.keep_place(own);
  std::mt19937 random(11);
  ObstacleSearch search;
  std::size_t count = 0;
  for (int i = 0; i < 40; ++i) {
    MovingSurface obstacle = own;
    ObstacleFrame frame;
    const ObstaclePlace start = make_place(3.0, random), turn = make_place(0.4, random);
    frame.set(start, {turn.axes * start.axes, start.origin + turn.origin}, 0.0, 1.0);
    put(frame.start(), own.start, obstacle.start);
    put(frame.end(), own.start, obstacle.end);
    MovingSurface ball = make_falling_ball(*of_ball, obstacle, random);
    for (int v = 0; v < ball.end.size(); ++v) {  // it touches at the end
      ball.end[v] = 0.8 * ball.start[v] + 0.2 * ball.end[v];
    }
    MovingSurface seen = ball;
    const double bow = frame.look_at(ball.start, ball.end, seen.start, seen.end);
    std::vector<TrianglePair> found;
    search.find_near_triangles(
        {seen, own, shape, true, frame.own_length(near) + bow, 0.0, frame.own_change(allowance)},
        found);
    std::set<std::pair<int, int>> known;
    for (const auto& [soft, other] : found) EXPECT_TRUE(known.emplace(soft, other).second);
    for (int v = 0; v < ball.end.size(); ++v) {
      ball.end[v] += allowance * make_place(4.0, random).origin.normalized();
    }
    const auto near_ones = near_triangles(ball, obstacle);
    EXPECT_TRUE(std::ranges::includes(known, near_ones)) << i;
    count += near_ones.size();
  }
  EXPECT_GT(count, 100u);
}

/// Straight ways in the world, at many moments of a step that turns the axes by up to 50 degrees.
TEST(ObstacleFrame, BoundsHowFarWaysBendInItsAxes) {
  std::mt19937 random(3);
  double greatest = 0.0;  // of the bound that is used
  for (int i = 0; i < 200; ++i) {
    const ObstaclePlace start = make_place(3.0, random), turn = make_place(0.85, random);
    const ObstaclePlace end{turn.axes * start.axes, start.origin + turn.origin};
    const double from = i % 3 == 0 ? 0.25 : 0.0, to = i % 2 == 0 ? 0.5 : 1.0;
    ObstacleFrame frame;
    frame.set(start, end, from, to);
    ASSERT_TRUE(frame.is_of_use());
    VertexArray before(1), after(1), own_before(1), own_after(1);
    before[0] = make_place(8.0, random).origin;
    after[0] = before[0] + make_place(4.0, random).origin;
    const double bow = frame.look_at(before, after, own_before, own_after);
    EXPECT_LT((frame.start() * Vec3(own_before[0]) - before[0]).norm(), 1e-12);
    EXPECT_LT((frame.end() * Vec3(own_after[0]) - after[0]).norm(), 1e-12);
    for (double s = 0.05; s < 1.0; s += 0.05) {
      const Mat3 axes = (1.0 - s) * frame.start().axes + s * frame.end().axes;
      const Vec3 origin = (1.0 - s) * frame.start().origin + s * frame.end().origin;
      const Vec3 own = axes.inverse() * ((1.0 - s) * before[0] + s * after[0] - origin);
      const double off = (own - ((1.0 - s) * own_before[0] + s * own_after[0])).norm();
      ASSERT_LE(off, bow + 1e-12);
      greatest = std::max(greatest, off / bow);
      const Vec3 arm = make_place(4.0, random).origin;
      ASSERT_LE(arm.norm(), frame.own_length((axes * arm).norm()) + 1e-12);
    }
  }
  EXPECT_GT(greatest, 0.5);
}

TEST(ObstacleFrame, BoundsTheWaysOfWhatLiesInIt) {
  std::mt19937 random(5);
  for (int i = 0; i < 100; ++i) {
    ObstacleFrame frame;
    frame.set(make_place(3.0, random), make_place(3.0, random), 0.0, 1.0);
    Bounds own;
    for (int corner = 0; corner < 2; ++corner) own.include(make_place(4.0, random).origin);
    const Bounds way = frame.way_of(own);
    const double longest = frame.longest_way(own);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int j = 0; j < 20; ++j) {
      const double z = uniform(random), y = uniform(random), x = uniform(random);
      const Vec3 vertex = own.low + own.size().cwiseProduct(Vec3(x, y, z));
      const Vec3 from = frame.start() * vertex, to = frame.end() * vertex;
      EXPECT_LE((to - from).norm(), longest + 1e-12);
      for (const Vec3& point : {from, to}) {
        EXPECT_TRUE((point.array() >= way.low.array() - 1e-12).all());
        EXPECT_TRUE((point.array() <= way.high.array() + 1e-12).all());
      }
    }
  }
}

/// The sphere of 20,480 triangles has 16 times as many as the other.
TEST(ObstacleSearch, FindsLittleMoreOfAFinerObstacle) {
  const auto of_ball = make_soft_mesh(make_icosphere(1.0, 2));
  std::vector<std::size_t> counts;
  for (const int subdivisions : {3, 5}) {
    const auto of_obstacle = make_soft_mesh(make_icosphere(4.0, subdivisions));
    MovingSurface obstacle = make_surface(*of_obstacle, Vec3::Zero());
    refit(obstacle, near);
    ObstacleShape shape(of_obstacle->topology, of_obstacle->rest_positions);
    shape.keep_place(obstacle);
    MovingSurface ball = make_surface(*of_ball, {0.1, 0.2, 5.0});
    for (int v = 0; v < ball.end.size(); ++v) ball.end[v].z() += 0.02;
    const std::vector<NearFeatures> found =
        find_first_to_pass({ball, obstacle, shape, true, near, least});
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
