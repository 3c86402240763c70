// Surfaces on their way: what the searches find against looking at everything, and whether ways
// that cross are seen.
#include "sim/swept/moving_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <tuple>

#include "sim/collision/bounding_sphere.h"
#include "sim/mesh/primitives.h"
#include "sim/mesh/rotation.h"
#include "sim/mesh/soft_mesh.h"
#include "sim/swept/feature_ways.h"

namespace pneuma::sim {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// A body's surface at rest in its rest shape.
MovingSurface make_surface(const SoftMesh& mesh, const Vec3& offset, bool is_rigid = false) {
  MovingSurface surface;
  surface.tree = std::make_shared<SurfaceTree>(mesh.topology, mesh.rest_positions, is_rigid);
  surface.start = mesh.rest_positions;
  for (int v = 0; v < surface.start.size(); ++v) surface.start[v] += offset;
  surface.end = surface.start;
  return surface;
}

void move(MovingSurface& surface, double by, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-by, by);
  for (int v = 0; v < surface.end.size(); ++v) {
    for (int k = 0; k < 3; ++k) surface.end[v][k] = surface.start[v][k] + uniform(random);
  }
}

using Named = std::tuple<FeatureKind, int, FeatureKind, int>;
Named named(const NearFeatures& pair) {
  return {pair.first.kind, pair.first.index, pair.second.kind, pair.second.index};
}

Bounds way_of(const MovingSurface& surface, const Feature& feature) {
  Bounds way;
  for (const int v : surface.tree->topology().feature_vertices(feature)) {
    way.include(surface.start[v]);
    way.include(surface.end[v]);
  }
  return way;
}

/// What a plane says is apart lies apart: of boxes side by side, whose edges are parallel, and of
/// the same shaken a little or a lot.
TEST(AreApart, IsTrueOnlyOfWhatIsThatFarApart) {
  const auto mesh = make_soft_mesh(make_box({1.0, 1.0, 1.0}, 2));
  const MeshTopology& of_box = mesh->topology;
  std::mt19937 random(4);
  int told = 0, near = 0;
  for (const double by : {0.0, 1e-14, 1e-9, 1e-3, 0.3}) {
    MovingSurface a = make_surface(*mesh, Vec3::Zero());
    MovingSurface b = make_surface(*mesh, {0.25, 1.01, 0.0});
    move(a, by, random);
    move(b, by, random);
    a.start = a.end;
    b.start = b.end;
    const auto look = [&](FeatureKind first, int first_count, FeatureKind second, int count) {
      for (int i = 0; i < first_count; ++i) {
        for (int j = 0; j < count; ++j) {
          const NearFeatures pair{{first, i}, {second, j}};
          for (const double distance : {0.001, 0.05, 0.5}) {
            const bool is_near =
                closest_points(a, b, pair, Moment::start, distance * (1.0 - 1e-9)).has_value();
            const bool is_apart = are_apart(a, b, pair, distance);
            EXPECT_FALSE(is_near && is_apart) << by << ' ' << i << ' ' << j << ' ' << distance;
            told += is_apart ? 1 : 0;
            near += is_near ? 1 : 0;
          }
        }
      }
    };
    look(FeatureKind::vertex, of_box.vertex_count(), FeatureKind::triangle,
         of_box.triangle_count());
    look(FeatureKind::edge, of_box.edge_count(), FeatureKind::edge, of_box.edge_count());
  }
  EXPECT_GT(told, 10'000);
  EXPECT_GT(near, 100);
}

/// Every pair of features whose ways' boxes are less than `margin` apart along each axis.
std::set<Named> all_near(const MovingSurface& a, const MovingSurface& b, double margin) {
  std::set<Named> result;
  const MeshTopology& of_a = a.tree->topology();
  const MeshTopology& of_b = b.tree->topology();
  const auto look = [&](FeatureKind first, int first_count, FeatureKind second, int second_count) {
    for (int i = 0; i < first_count; ++i) {
      Bounds way = way_of(a, {first, i});
      way.low.array() -= margin;
      way.high.array() += margin;
      for (int j = 0; j < second_count; ++j) {
        if (overlap(way, way_of(b, {second, j}))) result.insert({first, i, second, j});
      }
    }
  };
  look(FeatureKind::vertex, of_a.vertex_count(), FeatureKind::triangle, of_b.triangle_count());
  look(FeatureKind::triangle, of_a.triangle_count(), FeatureKind::vertex, of_b.vertex_count());
  look(FeatureKind::edge, of_a.edge_count(), FeatureKind::edge, of_b.edge_count());
  return result;
}

TEST(MovingSurface, FindsAllThatIsNearAndEachOnce) {
  std::mt19937 random(1);
  const auto ball = make_soft_mesh(make_icosphere(1.0, 2));
  const auto torus = make_soft_mesh(make_torus(1.2, 0.4, 12, 12));
  constexpr double margin = 0.02;
  for (int i = 0; i < 10; ++i) {
    MovingSurface a = make_surface(*ball, {0.12 * i, 0.0, 0.1});
    MovingSurface b = make_surface(*torus, {0.0, 0.05 * i, 0.0});
    move(a, 0.1, random);
    move(b, 0.1, random);
    refit(a, 0.5 * margin);
    refit(b, 0.5 * margin);
    std::vector<NearFeatures> pairs;
    find_near_features(a, b, pairs);
    std::set<Named> found;
    for (const NearFeatures& pair : pairs) {
      EXPECT_TRUE(found.insert(named(pair)).second) << "a pair was found twice";
    }
    const std::set<Named> near = all_near(a, b, margin);
    EXPECT_TRUE(std::ranges::includes(found, near)) << i;
    EXPECT_GT(near.size(), 0u) << i;
  }
}

TEST(MovingSurface, HasNoEdgesWithinTheFacesOfABox) {
  const auto cube = make_soft_mesh(make_box({2.0, 2.0, 2.0}, 1));
  const SurfaceTree rigid(cube->topology, cube->rest_positions, true);
  const SurfaceTree soft(cube->topology, cube->rest_positions, false);
  int flat = 0;
  for (int e = 0; e < cube->topology.edge_count(); ++e) {
    flat += rigid.is_flat(e) ? 1 : 0;
    EXPECT_FALSE(soft.is_flat(e)) << "a soft face bends";
  }
  EXPECT_EQ(flat, 6);
  EXPECT_DOUBLE_EQ(rigid.mean_edge(), 2.0);
}

/// Of all pairs, those that stand for their nearest parts have different parts.
TEST(MovingSurface, OnePairStandsForEachPairOfParts) {
  const auto cube = make_soft_mesh(make_box({2.0, 2.0, 2.0}, 1));
  // Corner over face, edge over edge, corner over edge, corner over corner.
  const Vec3 offsets[] = {
      {0.3, 0.4, 2.01}, {1.9, 0.3, 2.01}, {2.005, 0.3, 2.01}, {2.01, 2.02, 2.03}};
  for (const Vec3& offset : offsets) {
    MovingSurface a = make_surface(*cube, Vec3::Zero(), true);
    MovingSurface b = make_surface(*cube, offset, true);
    refit(a, 0.1);
    refit(b, 0.1);
    std::vector<NearFeatures> pairs;
    find_near_features(a, b, pairs);
    std::vector<Vec3> points;  // the middles between nearest points
    double nearest = 1.0;
    for (const NearFeatures& pair : pairs) {
      const ClosestPoints closest = *closest_points(a, b, pair, Moment::start, unlimited);
      if (!stands_for_its_parts(a, b, pair, closest, 0.0, 1e-6)) continue;
      nearest = std::min(nearest, closest.distance);
      points.push_back(0.5 * (closest.first_point + closest.second_point));
    }
    const Vec3 beyond = (offset - Vec3::Constant(2.0)).cwiseMax(0.0);
    EXPECT_NEAR(nearest, beyond.norm(), 1e-12) << "the nearest pair is left out";
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GT((points[i] - points[j]).norm(), 1e-9) << "two pairs stand for one place";
      }
    }
  }
}

/// A face that lies on another, turned so that its edges cross the other's, and tilted by less than
/// a degree.
TEST(MovingSurface, FacesThatLieOnEachOtherTouchAtAllTheirCorners) {
  const auto cube = make_soft_mesh(make_box({2.0, 2.0, 2.0}, 1));
  MovingSurface below = make_surface(*cube, Vec3::Zero(), true);
  MovingSurface above = make_surface(*cube, Vec3::Zero(), true);
  const Mat3 turn = rotation_of_degrees({0.5, 0.3, 45.0}).toRotationMatrix();
  for (int v = 0; v < above.start.size(); ++v) {
    above.start[v] = above.end[v] = turn * above.start[v] + Vec3(0.0, 0.0, 2.02);
  }
  refit(above, 0.1);
  refit(below, 0.1);
  std::vector<NearFeatures> pairs;
  find_near_features(above, below, pairs);
  const auto standing = [&](double sine_of_flat) {
    return std::ranges::count_if(pairs, [&](const NearFeatures& pair) {
      const auto closest = closest_points(above, below, pair, Moment::start, 0.1);
      return closest && stands_for_its_parts(above, below, pair, *closest, 0.0, sine_of_flat);
    });
  };
  EXPECT_EQ(standing(1e-6), 1);
  EXPECT_EQ(standing(0.03), 8);  // where edges cross
}

/// The distance of a pair at a moment between start, 0, and end, 1.
double distance_at(const MovingSurface& a, const MovingSurface& b, const NearFeatures& pair,
                   double t) {
  MovingSurface now_a = a, now_b = b;
  now_a.start.rows() = (1.0 - t) * a.start.rows() + t * a.end.rows();
  now_b.start.rows() = (1.0 - t) * b.start.rows() + t * b.end.rows();
  return closest_points(now_a, now_b, pair, Moment::start, unlimited)->distance;
}

void turn(MovingSurface& surface, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
          .normalized();
  for (int v = 0; v < surface.start.size(); ++v) {
    surface.start[v] = (rotation * Vec3(surface.start[v])).eval();
  }
}

/// Every pair of features that come within `margin` of each other at one of a few moments.
std::set<Named> all_that_meet(const MovingSurface& a, const MovingSurface& b, double margin) {
  std::set<Named> result;
  const MeshTopology& of_a = a.tree->topology();
  const MeshTopology& of_b = b.tree->topology();
  const auto look = [&](Feature first, Feature second) {
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      if (distance_at(a, b, {first, second}, t) < margin) result.insert(named({first, second}));
    }
  };
  for (int v = 0; v < 8; ++v) {
    for (int t = 0; t < 12; ++t) {
      look({FeatureKind::vertex, v}, {FeatureKind::triangle, t});
      look({FeatureKind::triangle, t}, {FeatureKind::vertex, v});
    }
  }
  for (int e = 0; e < of_a.edge_count(); ++e) {
    for (int f = 0; f < of_b.edge_count(); ++f) {
      if (a.tree->is_flat(e) || b.tree->is_flat(f)) continue;
      look({FeatureKind::edge, e}, {FeatureKind::edge, f});
    }
  }
  return result;
}

TEST(MovingSurface, OfBoxesFindsAllThatMeet) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto cube = make_soft_mesh(make_box({2.0, 2.0, 2.0}, 1));
  const auto plate = make_soft_mesh(make_box({3.0, 0.1, 2.0}, 1));
  std::size_t met = 0, looked_at = 0;
  for (int i = 0; i < 240; ++i) {
    MovingSurface a = make_surface(*cube, Vec3::Zero(), true);
    MovingSurface b = make_surface(*plate, Vec3::Zero(), true);
    turn(a, random);
    turn(b, random);
    const Vec3 away = 1.4 * Vec3(uniform(random), uniform(random), uniform(random)).normalized();
    for (int v = 0; v < 8; ++v) b.start[v] += away;
    move(a, 0.1, random);
    move(b, 0.1, random);
    refit(a, 0.02);
    refit(b, 0.03);
    std::vector<NearFeatures> pairs;
    find_near_features(a, b, pairs);
    std::set<Named> found;
    for (const NearFeatures& pair : pairs) {
      EXPECT_TRUE(found.insert(named(pair)).second) << "a pair was found twice";
    }
    const std::set<Named> meeting = all_that_meet(a, b, 0.05);
    EXPECT_TRUE(std::ranges::includes(found, meeting)) << i;
    met += meeting.size();
    looked_at += found.size();
  }
  EXPECT_GT(met, 300u);
  EXPECT_LT(looked_at, 20 * met);
}

TEST(Ways, ThatComeNearAreSeenAndThoseThatStayApartAreNot) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto tetrahedron = make_soft_mesh(
      TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {Triangle{0, 2, 1}, Triangle{0, 1, 3}, Triangle{0, 3, 2}, Triangle{1, 2, 3}}});
  const NearFeatures kinds[] = {{{FeatureKind::vertex, 0}, {FeatureKind::triangle, 3}},
                                {{FeatureKind::triangle, 3}, {FeatureKind::vertex, 0}},
                                {{FeatureKind::edge, 5}, {FeatureKind::edge, 0}}};
  constexpr int samples = 200;
  int near = 0, far = 0;
  for (int i = 0; i < 1'500; ++i) {
    MovingSurface a = make_surface(*tetrahedron, Vec3::Zero());
    MovingSurface b = make_surface(*tetrahedron, {uniform(random), uniform(random), 1.5});
    for (int v = 0; v < 4; ++v) {
      for (int k = 0; k < 3; ++k) {
        a.start[v][k] += 0.5 * uniform(random);
        b.start[v][k] += 0.5 * uniform(random);
      }
    }
    a.end = a.start;
    b.end = b.start;
    move(a, 1.5, random);
    move(b, 1.5, random);
    const NearFeatures& pair = kinds[i % 3];
    const double distance = distance_at(a, b, pair, 0.0);
    if (distance < 1e-3) continue;
    double least = distance;
    for (int s = 1; s <= samples; ++s) {
      least = std::min(least, distance_at(a, b, pair, static_cast<double>(s) / samples));
    }
    const auto seen = time_of_meeting(a, b, pair, distance, 0.1 * distance);
    // Between samples the features move by up to 6 / 200 m against each other.
    if (least < 0.1 * distance) {
      ASSERT_TRUE(seen) << i;
      const ClosestPoints met = closest_points_at(a, b, pair, *seen);
      EXPECT_NEAR(met.distance, distance_at(a, b, pair, *seen), 1e-12) << i;
      EXPECT_LT(met.distance, 0.12 * distance) << i;
      EXPECT_GT(met.distance, 0.1 * distance) << "they crossed before";
      ++near;
    } else if (least > 0.15 * distance + 0.03) {
      EXPECT_FALSE(seen) << i;
      ++far;
    }
  }
  EXPECT_GT(near, 50);
  EXPECT_GT(far, 500);
}

TEST(Ways, OfACommonMotionDoNotCollideHoweverLong) {
  const auto cube = make_soft_mesh(make_box({1.0, 1.0, 1.0}, 1));
  MovingSurface a = make_surface(*cube, Vec3::Zero(), true);
  MovingSurface b = make_surface(*cube, {0.0, 0.0, 1.001}, true);
  for (int v = 0; v < 8; ++v) {
    a.end[v] += Vec3(1000.0, 0.0, -500.0);
    b.end[v] += Vec3(1000.0, 0.0, -500.0);
  }
  refit(a, 0.01);
  refit(b, 0.01);
  std::vector<NearFeatures> pairs;
  find_near_features(a, b, pairs);
  EXPECT_FALSE(pairs.empty());
  for (const NearFeatures& pair : pairs) {
    const double distance = distance_at(a, b, pair, 0.0);
    EXPECT_FALSE(time_of_meeting(a, b, pair, distance, 0.1 * distance));
    EXPECT_EQ(greatest_change(a, b, pair), 0.0);
  }
}

}  // namespace
}  // namespace pneuma::sim
