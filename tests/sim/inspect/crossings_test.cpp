#include "sim/inspect/crossings.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// Every edge against every triangle, without a tree. For bodies in no special position.
int count_by_brute_force(const ClosedSurface& edges_of, const ClosedSurface& triangles_of,
                         bool own) {
  int count = 0;
  for (const auto& [p, q] : edges_of.edges) {
    bool passes = false;
    for (const auto& [a, b, c] : triangles_of.triangles) {
      if (own && (p == a || p == b || p == c || q == a || q == b || q == c)) continue;
      passes |= base::find_passage(edges_of.points[at(p)], edges_of.points[at(q)],
                                   triangles_of.points[at(a)], triangles_of.points[at(b)],
                                   triangles_of.points[at(c)])
                    .direction != 0;
    }
    count += passes;
  }
  return count;
}

Crossings brute_force(const World& world) {
  const std::vector<ClosedSurface> surfaces = closed_surfaces(world);
  Crossings result;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    for (std::size_t j = i; j < surfaces.size(); ++j) {
      int edges = count_by_brute_force(surfaces[i], surfaces[j], i == j);
      if (i != j) edges += count_by_brute_force(surfaces[j], surfaces[i], false);
      (i == j ? result.within_bodies : result.between_bodies) += edges;
      if (edges > 0) result.pairs.push_back({static_cast<int>(i), static_cast<int>(j), edges});
    }
  }
  return result;
}

World random_bodies(unsigned seed) {
  World world;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&](double size) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return Vec3(size * x, size * y, size * z);
  };
  for (int i = 0; i < 3; ++i) {
    world.soft.push_back(make_body(make_sphere(2.0, 8, 8), vector(4.0)));
    perturb(world.soft.back(), i == 0 ? 0.4 : 0.1, seed + 7);  // the first passes through itself
  }
  world.soft.push_back(make_body(make_torus(2.5, 0.8, 12, 8), vector(4.0)));
  for (int i = 0; i < 5; ++i) {
    const Vec3 size = Vec3(1.6, 1.6, 1.6) + vector(1.5);
    world.rigid.push_back(make_rigid(size, vector(5.0)));
    world.rigid.back().orientation =
        Eigen::AngleAxisd(3.0 * uniform(random), vector(1.0).normalized());
  }
  return world;
}

TEST(Crossings, OfRandomBodiesAreThoseOfAllEdgesAndTriangles) {
  int within = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const World world = random_bodies(seed);
    const Crossings expected = brute_force(world), found = crossings(world);
    EXPECT_EQ(found.between_bodies, expected.between_bodies);
    EXPECT_EQ(found.within_bodies, expected.within_bodies);
    EXPECT_EQ(found.pairs, expected.pairs);
    EXPECT_GT(found.between_bodies, 0);
    within += found.within_bodies;
  }
  EXPECT_GT(within, 0);
}

TEST(Crossings, OfARodThroughASphereAreItsFourEdgesAtLeast) {
  // No vertex of the one is inside the other.
  World world;
  world.soft.push_back(make_body(make_sphere(3.5, 8, 8)));
  world.rigid.push_back(make_rigid({12.0, 0.3, 0.3}, {0.0, 0.13, 0.21}));
  const Crossings found = crossings(world);
  EXPECT_GE(found.between_bodies, 4);
  EXPECT_EQ(found.within_bodies, 0);
  ASSERT_NE(first_crossing_bodies(found), nullptr);
  EXPECT_EQ(*first_crossing_bodies(found), (CrossingPair{0, 1, found.between_bodies}));
  world.rigid[0].position.z() = 3.7;
  EXPECT_EQ(crossings(world).between_bodies, 0);
  EXPECT_EQ(first_crossing_bodies(crossings(world)), nullptr);
}

TEST(Crossings, OfBoxesThatTouchAreNone) {
  World world;
  world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, Vec3::Zero()));
  const Vec3 touching[] = {
      {2.0, 0.0, 0.0}, {2.0, 2.0, 0.0}, {2.0, 2.0, 2.0}, {0.5, 0.25, 2.0}, {0.0, 0.0, 0.0}};
  for (const Vec3& place : touching) {
    world.rigid.resize(1);
    world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, place));
    EXPECT_EQ(crossings(world).between_bodies, 0) << place.transpose();
  }
  // One unit in the last place deeper: of each box two level edges pass through the other's sides,
  // and one upright edge through its top or bottom.
  world.rigid[1].position = {0.5, 0.25, std::nextafter(2.0, 0.0)};
  EXPECT_EQ(crossings(world).between_bodies, 6);
}

TEST(Crossings, AreNotLostWhereARodMeetsDiagonalsAndVertices) {
  // The rod's edges run through the middles, edges and vertices of the cube's triangles.
  for (const int squares : {1, 2, 4}) {
    for (const double offset : {0.0, 0.25, 0.5}) {
      World world;
      world.soft.push_back(make_body(make_box({2.0, 2.0, 2.0}, squares)));
      world.rigid.push_back(make_rigid({4.0, 0.5, 0.5}, {0.0, offset, offset}));
      EXPECT_GE(crossings(world).between_bodies, 4) << squares << " squares, " << offset;
    }
  }
}

TEST(Crossings, OfAnEdgeThatTouchesAnotherFromOutsideAreNone) {
  // A diamond: its edge along y touches the edge along x of the one below, at the middle of both.
  World world;
  world.soft.push_back(make_body({{{-2, 0, 0}, {2, 0, 0}, {0, -1, -1}, {0, 1, -1}},
                                  {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}}));
  world.soft.push_back(make_body({{{0, -2, 0}, {0, 2, 0}, {-1, 0, 1}, {1, 0, 1}},
                                  {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}}));
  EXPECT_EQ(crossings(world).between_bodies, 0);
  for (int v = 0; v < 4; ++v) world.soft[1].positions[v].z() -= 0x1p-40;
  EXPECT_GT(crossings(world).between_bodies, 0);
}

TEST(Crossings, OfABodyWithItselfAreCountedApart) {
  World world;
  world.soft.push_back(make_body(make_sphere(2.0, 12, 12)));
  EXPECT_EQ(crossings(world).within_bodies, 0);
  // One vertex is drawn through the whole body and out on the other side.
  Vec3 first = world.soft[0].positions[0];
  world.soft[0].positions[0] = -1.5 * first;
  const Crossings found = crossings(world);
  EXPECT_GT(found.within_bodies, 0);
  EXPECT_EQ(found.between_bodies, 0);
  EXPECT_EQ(first_crossing_bodies(found), nullptr);
}

TEST(Crossings, OfTenThousandTrianglesTakeMilliseconds) {
  World world;
  for (const double x : {0.0, 3.0})
    world.soft.push_back(make_body(make_torus(3.0, 1.0, 100, 50), {x, 0.01, 0.02}));
  ASSERT_EQ(world.soft[0].mesh->topology.triangle_count(), 10000);
  const auto start = std::chrono::steady_clock::now();
  const Crossings found = crossings(world);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_GT(found.between_bodies, 50);
  RecordProperty("milliseconds", std::to_string(1e3 * seconds.count()));
  // Of all edges with all triangles there are 1.2e9 pairs, which take 10 s.
  EXPECT_LT(seconds.count(), 1.0);
}

}  // namespace
}  // namespace pneuma::sim
