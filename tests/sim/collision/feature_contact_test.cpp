// Contacts between features of meshes: what is said to touch, and the rule for the normal.
#include "sim/collision/feature_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "sim/mesh/primitives.h"
#include "tests/sim/collision/surface_body.h"

namespace pneuma::sim {
namespace {

void move(SurfaceBody& body, const Vec3& by) {
  for (int i = 0; i < body.positions.size(); ++i) body.positions[i] += by;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(engine_); }
  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
  Vec3 point() {
    const double x = 2.0 * unit() - 1.0;
    const double y = 2.0 * unit() - 1.0;
    return {x, y, 2.0 * unit() - 1.0};
  }
  Vec3 grid_point() {
    const int x = below(2);
    const int y = below(2);
    return Vec3(x, y, below(2));
  }
  Feature feature(const MeshTopology& topology) {
    switch (below(3)) {
      case 0:
        return {FeatureKind::vertex, below(topology.vertex_count())};
      case 1:
        return {FeatureKind::edge, below(topology.edge_count())};
      default:
        return {FeatureKind::triangle, below(topology.triangle_count())};
    }
  }

 private:
  std::mt19937 engine_;
};

std::set<int> vertices_of(const SurfaceBody& body, Feature feature) {
  const auto span = body.topology.feature_vertices(feature);
  return {span.begin(), span.end()};
}

bool contains(const Triangle& triangle, const std::set<int>& vertices) {
  return std::ranges::all_of(vertices, [&](int v) { return std::ranges::count(triangle, v) > 0; });
}

/// From the triangles alone, without edges and rings: all that have the feature's vertices.
Vec3 reference_normal(const SurfaceBody& body, Feature feature) {
  const std::set<int> vertices = vertices_of(body, feature);
  Vec3 sum = Vec3::Zero();
  for (const Triangle& t : body.topology.triangles()) {
    if (!contains(t, vertices)) continue;
    const Vec3 a = body.point(t[0]);
    const Vec3 twice_area = (body.point(t[1]) - a).cross(body.point(t[2]) - a);
    sum += vertices.size() == 1 ? twice_area : twice_area.normalized();
  }
  return sum.normalized();
}

/// A torus and a sphere, both bent out of shape and overlapping, and features of theirs that touch.
struct Sample {
  SurfaceBody torus{make_torus(4.0, 1.5, 16, 16)};
  SurfaceBody sphere{make_sphere(3.0, 8, 8)};

  explicit Sample(Random& random) {
    for (SurfaceBody* body : {&torus, &sphere}) {
      for (int i = 0; i < body->positions.size(); ++i) body->positions[i] += 0.3 * random.point();
    }
    move(sphere, 4.0 * random.point());
  }
};

/// Calls `check` with every contact found between random features of many samples.
template <class Check>
void for_each_contact(Check check) {
  Random random(11);
  int contacts = 0;
  for (int s = 0; s < 100; ++s) {
    const Sample sample(random);
    for (int i = 0; i < 3000; ++i) {
      const Feature first = random.feature(sample.torus.topology);
      const Feature second = random.feature(sample.sphere.topology);
      const auto contact =
          find_feature_contact(sample.torus.surface(), first, sample.sphere.surface(), second, 1.0);
      if (!contact) continue;
      ++contacts;
      check(sample, first, second, *contact);
    }
  }
  EXPECT_GT(contacts, 1000);
}

TEST(FeatureContact, NormalIsThatOfTheHigherFeatureOrOfTheSecond) {
  std::set<std::pair<FeatureKind, FeatureKind>> kinds;
  for_each_contact([&](const Sample& sample, Feature, Feature, const FeatureContact& contact) {
    kinds.emplace(contact.first.kind, contact.second.kind);
    // Away from the torus, the first body, means that the impulse on it is the other way.
    const Vec3 expected = contact.first.kind > contact.second.kind
                              ? Vec3(-reference_normal(sample.torus, contact.first))
                              : reference_normal(sample.sphere, contact.second);
    // A few roundings of unit vectors; sums of up to eight area vectors in another order.
    ASSERT_LE((contact.normal - expected).norm(), 1e-13);
    ASSERT_NEAR(contact.normal.norm(), 1.0, 1e-15);
  });
  // Nearest points of two triangles are never inside both, but every other combination occurs.
  EXPECT_EQ(kinds.size(), 8U);
  EXPECT_FALSE(kinds.contains({FeatureKind::triangle, FeatureKind::triangle}));
}

TEST(FeatureContact, NamesAPartOfEachFeatureThatHoldsThePoint) {
  for_each_contact(
      [](const Sample& sample, Feature first, Feature second, const FeatureContact& contact) {
        ASSERT_TRUE(std::ranges::includes(vertices_of(sample.torus, first),
                                          vertices_of(sample.torus, contact.first)));
        ASSERT_TRUE(std::ranges::includes(vertices_of(sample.sphere, second),
                                          vertices_of(sample.sphere, contact.second)));
        // A vertex is its point; of an edge or a triangle the vertices span the plane or line the
        // point is on, so that it has no component across them. Coordinates below 10, tens
        // of roundings.
        const auto off_feature = [](const SurfaceBody& body, Feature feature, const Vec3& point) {
          const auto v = body.topology.feature_vertices(feature);
          const Vec3 offset = point - body.point(v[0]);
          if (v.size() == 1) return offset.norm();
          const Vec3 side = (body.point(v[1]) - body.point(v[0])).normalized();
          if (v.size() == 2) return offset.cross(side).norm();
          return std::abs(offset.dot(side.cross(body.point(v[2]) - body.point(v[0])).normalized()));
        };
        ASSERT_LE(off_feature(sample.torus, contact.first, contact.first_point), 1e-13);
        ASSERT_LE(off_feature(sample.sphere, contact.second, contact.second_point), 1e-13);
        ASSERT_NEAR((contact.first_point - contact.second_point).norm(), contact.distance, 1e-14);
      });
}

// The same two features the other way round: the same points, and for features of different order
// the opposite impulse. Of equal ones each time the second decides.
TEST(FeatureContact, ExchangedBodiesGetTheOppositeImpulse) {
  int of_equal_order = 0;
  for_each_contact([&](const Sample& sample, Feature first, Feature second,
                       const FeatureContact& contact) {
    const auto exchanged =
        find_feature_contact(sample.sphere.surface(), second, sample.torus.surface(), first, 1.0);
    ASSERT_TRUE(exchanged);
    ASSERT_NEAR(exchanged->distance, contact.distance, 1e-14);
    if (contact.distance == 0.0) return;  // features that cross may do so in two places
    ASSERT_EQ(exchanged->first, contact.second);
    ASSERT_EQ(exchanged->second, contact.first);
    if (contact.first.kind != contact.second.kind) {
      ASSERT_EQ(exchanged->normal, -contact.normal);
    } else {
      ++of_equal_order;
      ASSERT_LE((exchanged->normal - reference_normal(sample.torus, contact.first)).norm(), 1e-13);
    }
  });
  EXPECT_GT(of_equal_order, 100);
}

// A vertex that has already passed through a face is still pushed out of it, not further in, which
// the direction between the nearest points would do.
TEST(FeatureContact, NormalPointsOutOfTheSurfaceOnBothSidesOfIt) {
  const SurfaceBody box(make_box({2.0, 2.0, 2.0}, 1));
  SurfaceBody probe(make_box({1.0, 1.0, 1.0}, 1));
  const int top = [&] {
    for (int i = 0;; ++i) {
      const Triangle& t = box.topology.triangles()[at(i)];
      if (std::ranges::all_of(t, [&](int v) { return box.point(v).z() == 1.0; })) return i;
    }
  }();
  const Triangle& t = box.topology.triangles()[at(top)];
  const Vec3 middle = (box.point(t[0]) + box.point(t[1]) + box.point(t[2])) / 3.0;
  for (const double height : {0.5, 0.0, -0.5}) {
    move(probe, middle + height * Vec3::UnitZ() - probe.point(0));
    const Feature vertex{FeatureKind::vertex, 0};
    const Feature face{FeatureKind::triangle, top};
    const auto contact = find_feature_contact(probe.surface(), vertex, box.surface(), face, 1.0);
    ASSERT_TRUE(contact);
    EXPECT_NEAR(contact->distance, std::abs(height), 1e-15);
    EXPECT_EQ(contact->normal, Vec3::UnitZ().eval()) << height;
    const auto other = find_feature_contact(box.surface(), face, probe.surface(), vertex, 1.0);
    ASSERT_TRUE(other);
    EXPECT_EQ(other->normal, -Vec3::UnitZ().eval()) << height;
  }
}

// Section 5.3.1's reason for the rule: on the inside of a torus the impulse points to the hole.
TEST(FeatureContact, InsideATorusTheBallIsPushedToTheMiddle) {
  const SurfaceBody torus(make_torus(4.0, 1.5, 16, 16));
  SurfaceBody ball(make_icosphere(1.0, 1));
  int contacts = 0;
  for (int t = 0; t < torus.topology.triangle_count(); ++t) {
    const Corners corners = triangle_corners(torus.surface(), t);
    const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    const Vec3 towards_axis(-middle.x(), -middle.y(), 0.0);
    const Vec3 normal = feature_normal(torus.surface(), {FeatureKind::triangle, t});
    if (normal.dot(towards_axis.normalized()) < 0.9) continue;
    move(ball, middle - ball.point(0));
    const auto contact = find_feature_contact(ball.surface(), {FeatureKind::vertex, 0},
                                              torus.surface(), {FeatureKind::triangle, t}, 1.0);
    ASSERT_TRUE(contact);
    EXPECT_GT(contact->normal.dot(towards_axis), 0.0);
    ++contacts;
  }
  EXPECT_GE(contacts, 32);
}

// A crumpled body: vertices that coincide, triangles without area or folded onto each other.
// Whatever touches, the normal is a unit vector.
TEST(FeatureContact, CrumpledBodiesStillHaveUnitNormals) {
  Random random(3);
  int contacts = 0;
  for (int s = 0; s < 300; ++s) {
    SurfaceBody a(make_icosphere(1.0, 1));
    SurfaceBody b(make_box({1.0, 1.0, 1.0}, 1));
    for (SurfaceBody* body : {&a, &b}) {
      const int kind = random.below(4);
      const Vec3 line = random.point();
      for (int i = 0; i < body->positions.size(); ++i) {
        if (kind == 0) body->positions[i] = random.grid_point();
        if (kind == 1) body->positions[i] = random.unit() * line;
        if (kind == 2) body->positions[i] = Vec3{random.unit(), random.unit(), 0.0};
        if (kind == 3) body->positions[i].setZero();
      }
    }
    for (int i = 0; i < 300; ++i) {
      const auto contact = find_feature_contact(a.surface(), random.feature(a.topology),
                                                b.surface(), random.feature(b.topology), 1.0);
      if (!contact) continue;
      ++contacts;
      ASSERT_NEAR(contact->normal.norm(), 1.0, 1e-15);
    }
  }
  EXPECT_GT(contacts, 10'000);
}

}  // namespace
}  // namespace pneuma::sim
