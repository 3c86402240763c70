// The exhaustive search for soft contacts against all pairs, tried one by one.
#include "sim/collision/find_exact.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "sim/inspect/inspect.h"
#include "tests/sim/contact_worlds.h"

namespace pneuma::sim {
namespace {

SurfaceView view(const SoftBody& body) { return {body.mesh->topology, body.positions}; }

/// Two bodies in and around each other, bent at random.
World crumpled_pair(unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Vec3 offset(4.0 + uniform(random), 2.0 * uniform(random), 2.0 * uniform(random));
  World world = make_free_world(make_body(make_torus(4.0, 1.5, 16, 16)));
  world.soft.push_back(make_body(make_icosphere(2.0, 2), offset));
  for (SoftBody& body : world.soft) perturb(body, 0.2, seed + 1);
  world.settings.skin_thickness = 0.2;
  return world;
}

TEST(SurfaceGrid, VisitsEveryTriangleWhoseBoxMeetsOnceAtMost) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-6.0, 6.0);
  SoftBody torus = make_body(make_torus(4.0, 1.5, 16, 16));
  perturb(torus, 0.3, 2);
  const SurfaceView surface = view(torus);
  const auto random_box = [&] {
    Bounds box;
    box.include(Vec3(uniform(random), uniform(random), 0.3 * uniform(random)));
    box.include(Vec3(uniform(random), uniform(random), 0.3 * uniform(random)));
    return box;
  };
  const auto meet = [](const Bounds& a, const Bounds& b) {
    return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
  };
  SurfaceGrid grid;
  int visits = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const Bounds region = random_box();
    grid.fill(surface, region);
    for (int query = 0; query < 20; ++query) {
      const Bounds box = random_box();
      std::multiset<int> visited;
      grid.for_each_near(box, [&](int triangle, const Bounds&) { visited.insert(triangle); });
      visits += static_cast<int>(visited.size());
      for (int t = 0; t < surface.topology.triangle_count(); ++t) {
        Bounds triangle;
        for (const Vec3& corner : triangle_corners(surface, t)) triangle.include(corner);
        EXPECT_LE(visited.count(t), 1U);
        // Within the region; outside of it the grid knows of no triangle.
        const Bounds inside{box.low.cwiseMax(region.low), box.high.cwiseMin(region.high)};
        if (!(inside.low.array() <= inside.high.array()).all()) continue;
        if (meet(triangle, inside)) {
          EXPECT_EQ(visited.count(t), 1U) << t;
        }
      }
    }
  }
  EXPECT_GT(visits, 1000);
}

TEST(SurfaceGrid, OfARegionWithoutTrianglesIsEmpty) {
  const SoftBody ball = make_body(make_icosphere(1.0, 1));
  SurfaceGrid grid;
  grid.fill(view(ball), {Vec3::Constant(5.0), Vec3::Constant(6.0)});
  grid.for_each_near({Vec3::Constant(-9.0), Vec3::Constant(9.0)},
                     [](int, const Bounds&) { FAIL(); });
}

TEST(CloseTriangles, AreThoseThatTryingAllPairsFinds) {
  std::size_t pairs = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const World world = crumpled_pair(seed);
    const SurfaceView first = view(world.soft[0]), second = view(world.soft[1]);
    const double reach = 0.4;
    const std::vector<CloseTriangles> found = find_close_triangles(first, second, reach);
    auto next = found.begin();
    for (int i = 0; i < first.topology.triangle_count(); ++i) {
      for (int j = 0; j < second.topology.triangle_count(); ++j) {
        const auto near =
            test_triangle_triangle(triangle_corners(first, i), triangle_corners(second, j), reach);
        if (!near) continue;
        ASSERT_NE(next, found.end());
        EXPECT_EQ(next->first, i);
        EXPECT_EQ(next->second, j);
        EXPECT_EQ(next->distance, near->distance);  // the same arithmetic
        ++next;
      }
    }
    EXPECT_EQ(next, found.end());
    pairs += found.size();
  }
  EXPECT_GT(pairs, 500U);
}

/// Distance of a feature from a whole surface, by trying all its triangles.
double distance_to(const SurfaceView& own, Feature feature, const SurfaceView& other) {
  double least = 1e30;
  for (int t = 0; t < other.topology.triangle_count(); ++t) {
    const auto near = find_feature_contact(own, feature, other, {FeatureKind::triangle, t}, least);
    if (near) least = near->distance;
  }
  return least;
}

TEST(FindExact, EveryVertexWithinReachHasAContact) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const World world = crumpled_pair(seed);
    std::vector<Contact> contacts;
    ExactScratch scratch;
    find_exact(world, 0, 1, scratch, contacts);
    std::set<int> touched[2];
    for (const Contact& contact : contacts) {
      if (contact.first.feature.kind == FeatureKind::vertex) {
        touched[0].insert(contact.first.feature.index);
      }
      if (contact.second.feature.kind == FeatureKind::vertex) {
        touched[1].insert(contact.second.feature.index);
      }
    }
    for (const int own : {0, 1}) {
      const SurfaceView surface = view(world.soft[at(own)]);
      const SurfaceView other = view(world.soft[at(1 - own)]);
      for (int v = 0; v < surface.topology.vertex_count(); ++v) {
        const double distance = distance_to(surface, {FeatureKind::vertex, v}, other);
        // Roundings at the reach itself decide nothing here: no vertex is that near to it.
        ASSERT_GT(std::abs(distance - 0.4), 1e-12);
        if (distance < 0.4) {
          EXPECT_TRUE(touched[own].contains(v)) << own << " " << v;
        }
      }
    }
    EXPECT_GT(touched[0].size() + touched[1].size(), 10U);
  }
}

TEST(FindExact, ReportsNoPairOfFeaturesTwice) {
  std::map<FeatureKind, int> kinds;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const World world = crumpled_pair(seed);
    std::vector<Contact> contacts;
    ExactScratch scratch;
    find_exact(world, 0, 1, scratch, contacts);
    std::set<std::pair<int, int>> known;
    for (const Contact& contact : contacts) {
      EXPECT_TRUE(known
                      .insert({world.soft[0].mesh->topology.feature_id(contact.first.feature),
                               world.soft[1].mesh->topology.feature_id(contact.second.feature)})
                      .second);
      ++kinds[std::max(contact.first.feature.kind, contact.second.feature.kind)];
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);  // roundings
      EXPECT_EQ(contact.first.body, 0);
      EXPECT_EQ(contact.second.body, 1);
    }
  }
  // Vertices lie over triangles, and edges cross.
  EXPECT_GT(kinds[FeatureKind::triangle], 10);
  EXPECT_GT(kinds[FeatureKind::edge], 10);
}

TEST(FindExact, BodiesOutOfReachHaveNoContacts) {
  World world = make_free_world(make_body(make_icosphere(1.0, 2)));
  world.soft.push_back(make_body(make_icosphere(1.0, 2), {3.1, 0.0, 0.0}));
  std::vector<Contact> contacts;
  ExactScratch scratch;
  find_exact(world, 0, 1, scratch, contacts);
  EXPECT_TRUE(contacts.empty()) << "1.1 m apart, and the reach is 1 m";
  for (int v = 0; v < world.soft[1].positions.size(); ++v) world.soft[1].positions[v].x() -= 0.3;
  find_exact(world, 0, 1, scratch, contacts);
  EXPECT_FALSE(contacts.empty()) << "0.8 m apart";
}

}  // namespace
}  // namespace pneuma::sim
