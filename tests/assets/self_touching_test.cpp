#include "assets/self_touching.h"

#include <gtest/gtest.h>

#include "sim/mesh/primitives.h"
#include "tests/assets/model_writers.h"

namespace pneuma::assets {
namespace {

struct PairCase {
  const char* what;
  std::vector<Vec3> vertices;
  Triangle second;  // the first is 0 1 2
  bool touch;
};

// The first triangle is always (0 0 0) (4 0 0) (0 4 0), but for the shared vertices' sake repeated.
const std::vector<Vec3> base = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};

std::vector<Vec3> with(std::initializer_list<Vec3> more) {
  std::vector<Vec3> result = base;
  result.insert(result.end(), more);
  return result;
}

const PairCase pairs[] = {
    {"apart", with({{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}), {3, 4, 5}, false},
    {"crossing", with({{1, 1, -1}, {1, 1, 1}, {5, 5, 1}}), {3, 4, 5}, true},
    {"a corner on the other's inside", with({{1, 1, 0}, {1, 2, 3}, {2, 1, 3}}), {3, 4, 5}, true},
    {"sides that cross", with({{2, -1, -1}, {2, 1, 1}, {2, -1, 1}}), {3, 4, 5}, true},
    {"coplanar, one within the other", with({{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}), {3, 4, 5}, true},
    {"coplanar, apart", with({{5, 5, 0}, {6, 5, 0}, {5, 6, 0}}), {3, 4, 5}, false},
    {"coplanar, a common corner that is not shared",
     with({{4, 0, 0}, {8, 0, 0}, {8, 4, 0}}),
     {3, 4, 5},
     true},
    {"a shared vertex only", with({{-4, 0, 0}, {0, -4, 2}}), {0, 3, 4}, false},
    {"a shared vertex, and through the inside", with({{4, 4, -1}, {4, 4, 1}}), {0, 3, 4}, true},
    {"a shared vertex, coplanar, one wedge in the other",
     with({{4, 3, 0}, {3, 4, 0}}),
     {0, 3, 4},
     true},
    {"a shared vertex, coplanar, wedges apart", with({{-4, 0, 0}, {0, -4, 0}}), {0, 3, 4}, false},
    {"a shared side, folded by 90 degrees", with({{1, 0, 4}}), {1, 0, 3}, false},
    {"a shared side, flat", with({{1, -4, 0}}), {1, 0, 3}, false},
    {"a shared side, folded flat", with({{1, 3, 0}}), {1, 0, 3}, true},
};

TEST(SelfTouching, PairsOfTrianglesWhicheverComesFirst) {
  for (const auto& [what, vertices, second, touch] : pairs) {
    const Triangle first = {0, 1, 2};
    EXPECT_EQ(find_self_touching({vertices, {first, second}}, 5).count, touch ? 1u : 0u) << what;
    EXPECT_EQ(find_self_touching({vertices, {second, first}}, 5).count, touch ? 1u : 0u) << what;
  }
}

TEST(SelfTouching, GoodSurfacesDoNot) {
  for (const sim::TriangleMesh& mesh :
       {cube(), crooked_box(), sim::make_box({1.0, 2.0, 3.0}, 7), sim::make_sphere(3.0, 8, 8),
        sim::make_torus(5.0, 2.0, 16, 16), sim::make_icosphere(1.0, 4),
        moved(sim::make_icosphere(1e-3, 3), {100.0, 200.0, 300.0})}) {
    const SelfTouching result = find_self_touching(mesh, 5);
    EXPECT_EQ(result.count, 0u);
    EXPECT_TRUE(result.complete);
  }
}

/// All pairs, without the tree: each alone in a mesh of two triangles and the same extent.
std::size_t count_pair_by_pair(const sim::TriangleMesh& mesh) {
  std::size_t count = 0;
  for (std::size_t s = 0; s < mesh.triangles.size(); ++s) {
    for (std::size_t t = s + 1; t < mesh.triangles.size(); ++t) {
      count += find_self_touching({mesh.vertices, {mesh.triangles[s], mesh.triangles[t]}}, 1).count;
    }
  }
  return count;
}

TEST(SelfTouching, TheTreeMissesNoPair) {
  const sim::TriangleMesh spheres =
      both(sim::make_icosphere(1.0, 2), moved(sim::make_icosphere(1.0, 2), {0.7, 0.3, 0.1}));
  const SelfTouching result = find_self_touching(spheres, 5);
  EXPECT_GT(result.count, 50u);  // the two meet in a circle of about fifty triangles
  EXPECT_EQ(result.count, count_pair_by_pair(spheres));
  ASSERT_EQ(result.first.size(), 5u);
  EXPECT_TRUE(std::is_sorted(result.first.begin(), result.first.end()));
  EXPECT_LT(result.first[0][0], 320);  // one of the first sphere
  EXPECT_GE(result.first[0][1], 320);  // with one of the second
}

}  // namespace
}  // namespace pneuma::assets
