#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <string>

#include "assets/cat/cat_mesh.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/topology.h"
#include "tests/support/plain_ply.h"

namespace pneuma::assets {
namespace {

using sim::at;
using sim::MeshTopology;
using sim::Triangle;
using sim::TriangleMesh;
using sim::Vec3;

class Cat : public testing::TestWithParam<CatSize> {
 protected:
  // MeshTopology refuses what is open, not manifold or not consistently oriented.
  Cat()
      : mesh_(parse_plain_ply(read_asset(GetParam().file))),
        topology_(static_cast<int>(mesh_.vertices.size()), mesh_.triangles),
        positions_(sim::to_vertex_array(mesh_.vertices)) {}

  Vec3 place(int vertex) const { return mesh_.vertices[at(vertex)]; }

  /// The parts into which the vertices that `kept` keeps fall, as sets, the largest first.
  template <class Kept>
  std::vector<std::set<int>> parts(const Kept& kept) const {
    std::vector<std::set<int>> result;
    std::set<int> seen;
    for (int start = 0; start < topology_.vertex_count(); ++start) {
      if (!kept(start) || seen.contains(start)) continue;
      std::set<int> part = {start};
      for (std::vector<int> open = {start}; !open.empty();) {
        const int v = open.back();
        open.pop_back();
        for (const auto& spoke : topology_.ring(v)) {
          if (kept(spoke.vertex) && part.insert(spoke.vertex).second) open.push_back(spoke.vertex);
        }
      }
      seen.insert(part.begin(), part.end());
      result.push_back(std::move(part));
    }
    std::sort(result.begin(), result.end(),
              [](const auto& a, const auto& b) { return a.size() > b.size(); });
    return result;
  }

  TriangleMesh mesh_;
  MeshTopology topology_;
  sim::VertexArray positions_;
};

INSTANTIATE_TEST_SUITE_P(Sizes, Cat, testing::ValuesIn(cat_sizes), [](const auto& instance) {
  const std::string file = instance.param.file;
  return file.substr(0, file.find('.'));
});

TEST_P(Cat, IsWhatTheGeneratorWrites) {
  EXPECT_TRUE(write_ply(make_cat(GetParam().edge_length)) == read_asset(GetParam().file))
      << "make it again as assets/cat/README.md says";
}

TEST_P(Cat, IsOneClosedOutwardSurfaceWithoutHandles) {
  EXPECT_EQ(topology_.vertex_count() - topology_.edge_count() + topology_.triangle_count(), 2)
      << "Euler: 2 - 2 genus";
  EXPECT_EQ(parts([](int) { return true; }).size(), 1u);
  // By hand: a trunk of 1.35 m x 0.24^2 pi, four legs of 0.6 m x 0.1^2 pi, a head of 4/3 pi 0.22^3
  // and a tail of 1 m x 0.09^2 pi are 0.39 m^3; neck, thighs and paws add to it. Outward is
  // positive.
  const double volume = sim::volume(topology_, positions_);
  EXPECT_GT(volume, 0.38);
  EXPECT_LT(volume, 0.47);
}

TEST_P(Cat, HasTheSizeItSays) {
  const std::string file = GetParam().file;
  const double named = std::stod(file.substr(file.find('_') + 1));
  EXPECT_NEAR(topology_.vertex_count() / named, 1.0, 0.05);
  const sim::Bounds box = sim::bounds(positions_);
  EXPECT_NEAR(box.size().x(), 2.0, 0.1);
  EXPECT_EQ(box.low.z(), 0.0) << "it stands on the ground";
}

TEST_P(Cat, IsEven) {
  std::vector<double> lengths;
  for (const auto& [a, b] : topology_.edges()) lengths.push_back((place(b) - place(a)).norm());
  std::sort(lengths.begin(), lengths.end());
  EXPECT_LE(lengths[lengths.size() * 95 / 100] / lengths[lengths.size() * 5 / 100], 2.0);

  double smallest = 180.0;
  for (const Triangle& triangle : mesh_.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 corner = place(triangle[i]);
      const Vec3 one = (place(triangle[(i + 1) % 3]) - corner).normalized();
      const Vec3 other = (place(triangle[(i + 2) % 3]) - corner).normalized();
      smallest = std::min(smallest, std::acos(one.dot(other)) * 180.0 / std::numbers::pi);
    }
  }
  EXPECT_GE(smallest, 20.0) << "degrees";
}

/// Six times the volume of a tetrahedron.
double orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).dot((c - a).cross(d - a));
}

bool pierces(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& t) {
  if (orientation(t[0], t[1], t[2], from) * orientation(t[0], t[1], t[2], to) > 0.0) return false;
  const double ab = orientation(from, to, t[0], t[1]);
  const double bc = orientation(from, to, t[1], t[2]);
  const double ca = orientation(from, to, t[2], t[0]);
  return (ab >= 0.0 && bc >= 0.0 && ca >= 0.0) || (ab <= 0.0 && bc <= 0.0 && ca <= 0.0);
}

TEST(Pierces, SeesTheInsideOfATriangleOnly) {
  const std::array<Vec3, 3> triangle = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_TRUE(pierces({0.3, 0.3, -1.0}, {0.3, 0.3, 1.0}, triangle));
  EXPECT_TRUE(pierces({0.3, 0.3, 1.0}, {0.3, 0.3, -1.0}, triangle));
  EXPECT_FALSE(pierces({0.6, 0.6, -1.0}, {0.6, 0.6, 1.0}, triangle)) << "beside it";
  EXPECT_FALSE(pierces({0.3, 0.3, 1.0}, {0.3, 0.3, 2.0}, triangle)) << "above it";
}

TEST_P(Cat, DoesNotRunThroughItself) {
  // Two triangles that cross have an edge of one through the other. All edges against all triangles
  // that are near along x and share no vertex with them.
  struct Slab {
    double low, high;
    int triangle;
  };
  std::vector<Slab> slabs;
  double widest = 0.0;
  for (int t = 0; t < topology_.triangle_count(); ++t) {
    const auto& [a, b, c] = mesh_.triangles[at(t)];
    const auto [low, high] = std::minmax({place(a).x(), place(b).x(), place(c).x()});
    slabs.push_back({low, high, t});
    widest = std::max(widest, high - low);
  }
  std::sort(slabs.begin(), slabs.end(), [](const Slab& l, const Slab& r) { return l.low < r.low; });
  int crossings = 0;
  for (const auto& [a, b] : topology_.edges()) {
    const Vec3 from = place(a), to = place(b);
    const Vec3 low = from.cwiseMin(to), high = from.cwiseMax(to);
    auto slab = std::lower_bound(slabs.begin(), slabs.end(), low.x() - widest,
                                 [](const Slab& s, double x) { return s.low < x; });
    for (; slab != slabs.end() && slab->low <= high.x(); ++slab) {
      const Triangle& t = mesh_.triangles[at(slab->triangle)];
      if (std::count(t.begin(), t.end(), a) + std::count(t.begin(), t.end(), b) > 0) continue;
      const std::array<Vec3, 3> corners = {place(t[0]), place(t[1]), place(t[2])};
      const Vec3 least = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
      const Vec3 most = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
      if ((least.array() > high.array()).any() || (most.array() < low.array()).any()) continue;
      crossings += pierces(from, to, corners);
    }
  }
  EXPECT_EQ(crossings, 0);
}

TEST_P(Cat, HasFourLegsTwoEarsAndATail) {
  // Cut level with the shins, only legs are left, one in each quarter; above the skull, two ears
  // and the tail.
  const auto below = parts([this](int v) { return place(v).z() < 0.4; });
  ASSERT_EQ(below.size(), 4u);
  std::set<std::pair<bool, bool>> quarters;
  for (const auto& leg : below)
    quarters.insert({place(*leg.begin()).x() > 0, place(*leg.begin()).y() > 0});
  EXPECT_EQ(quarters.size(), 4u);

  const auto above = parts([this](int v) { return place(v).z() > 1.45; });
  ASSERT_EQ(above.size(), 3u);
  int ears = 0, tails = 0;
  for (const auto& part : above) (place(*part.begin()).x() > 0.0 ? ears : tails) += 1;
  EXPECT_EQ(ears, 2);
  EXPECT_EQ(tails, 1);
}

TEST_P(Cat, IsTwoEdgesThickAtTheEndsOfEarsAndTail) {
  // Around a part one edge thick there is a way of three edges that is no triangle of the mesh.
  std::set<std::array<int, 3>> faces;
  for (Triangle triangle : mesh_.triangles) {
    std::sort(triangle.begin(), triangle.end());
    faces.insert(triangle);
  }
  for (const auto& [a, b] : topology_.edges()) {
    std::set<int> near_a;
    for (const auto& spoke : topology_.ring(a)) near_a.insert(spoke.vertex);
    for (const auto& spoke : topology_.ring(b)) {
      if (spoke.vertex < b || !near_a.contains(spoke.vertex)) continue;
      EXPECT_TRUE(faces.contains({a, b, spoke.vertex})) << "at " << place(a).transpose();
    }
  }
  // The tips themselves: from one side of the ring around the topmost vertex to the other it is two
  // edges, along the surface, and more than one edge as the crow flies.
  for (const auto& part : parts([this](int v) { return place(v).z() > 1.45; })) {
    const int tip = *std::max_element(part.begin(), part.end(),
                                      [this](int l, int r) { return place(l).z() < place(r).z(); });
    double across = 0.0, edges = 0.0;
    const auto ring = topology_.ring(tip);
    EXPECT_GE(ring.size(), 4u);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 here = place(ring[i].vertex);
      const Vec3 opposite = place(ring[(i + ring.size() / 2) % ring.size()].vertex);
      across += (opposite - here).norm();
      edges += (place(tip) - here).norm();
    }
    EXPECT_GT(across / edges, 1.0) << "tip at " << place(tip).transpose();
  }
}

}  // namespace
}  // namespace pneuma::assets
