// Contacts of boxes with soft bodies, against a look at every vertex and every corner.
#include <gtest/gtest.h>

#include <set>

#include "sim/collision/bounding_sphere.h"
#include "sim/collision/find_body_contacts.h"
#include "sim/collision/point_in_body.h"
#include "tests/sim/collision/uniform.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// The paper's torus, dented.
SoftBody dented_torus() {
  SoftBody body = make_body(make_torus(4.0, 1.5, 16, 16));
  perturb(body, 0.2, 1);
  return body;
}

RigidBox box_near(const Bounds& around, Uniform& uniform) {
  const Vec3 half{uniform(0.1, 1.5), uniform(0.1, 1.5), uniform(0.1, 1.5)};
  RigidBox box = make_rigid(2.0 * half, uniform.within(around, 1.5));
  const Vec3 axis = uniform.within({-Vec3::Ones(), Vec3::Ones()}, 0.0);
  box.orientation = Eigen::AngleAxisd(uniform(0.0, 3.0), axis.normalized());
  return box;
}

TEST(VertexColumns, FindAllVerticesOfARegionOnce) {
  const SoftBody body = dented_torus();
  const Bounds around = bounds(body.positions);
  VertexColumns columns;
  columns.fill(body.positions, around);
  Uniform uniform(2);
  std::size_t within = 0;
  for (int i = 0; i < 2'000; ++i) {
    Bounds region;
    region.include(uniform.within(around, 0.5));
    region.include(uniform.within(around, 0.5));
    std::multiset<int> visited;
    columns.for_each_near(region, [&](int v) { visited.insert(v); });
    for (int v = 0; v < body.positions.size(); ++v) {
      const Vec3 p = body.positions[v];
      const bool inside =
          (p.array() >= region.low.array()).all() && (p.array() <= region.high.array()).all();
      ASSERT_LE(visited.count(v), 1U);
      if (inside) {
        ASSERT_EQ(visited.count(v), 1U);
      }
      within += inside ? 1 : 0;
    }
  }
  EXPECT_GT(within, 10'000U);
}

TEST(VertexColumns, HoldAllVerticesOfABodyWithoutExtent) {
  VertexArray positions(5);
  for (int v = 0; v < 5; ++v) positions[v] = Vec3(1.0, 2.0, v);
  VertexColumns columns;
  columns.fill(positions, bounds(positions));
  int visited = 0;
  columns.for_each_near(bounds(positions), [&](int) { ++visited; });
  EXPECT_EQ(visited, 5);
}

/// Vertices in ascending order, then corners.
void expect_all_contacts(const World& world, const PlacedBox& placed,
                         const std::vector<Contact>& contacts) {
  const SoftBody& body = world.soft[0];
  auto contact = contacts.begin();
  for (int v = 0; v < body.positions.size(); ++v) {
    const auto exit = find_box_exit(placed.box, body.positions[v]);
    if (!exit) continue;
    ASSERT_NE(contact, contacts.end());
    ASSERT_EQ(contact->first.feature, (Feature{FeatureKind::vertex, v}));
    ASSERT_EQ(contact->second.kind, SideKind::rigid);
    ASSERT_EQ(contact->point, Vec3(body.positions[v]));
    ASSERT_EQ(contact->normal, exit->normal);
    ASSERT_EQ(contact->depth, exit->depth);
    ++contact;
  }
  const SurfaceView surface{body.mesh->topology, body.positions};
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = placed.box.corner(i);
    if (!is_inside(surface, corner)) continue;
    ASSERT_NE(contact, contacts.end());
    ASSERT_EQ(contact->first.kind, SideKind::rigid);
    ASSERT_EQ(contact->second.feature.kind, FeatureKind::triangle);
    ASSERT_LT((contact->point - corner).norm(), 1e-14);  // roundings of coordinates below 8
    ASSERT_GT(contact->depth, 0.0);
    ++contact;
  }
  ASSERT_EQ(contact, contacts.end());
}

TEST(SoftRigidContacts, AreThoseOfAllVerticesAndCorners) {
  World world;
  world.soft.push_back(dented_torus());
  const SoftBody& body = world.soft[0];
  const Bounds around = bounds(body.positions);
  SurfaceColumns columns;
  columns.fill({body.mesh->topology, body.positions}, around);
  Uniform uniform(3);
  int of_vertices = 0, of_corners = 0, without = 0;
  for (int i = 0; i < 10'000; ++i) {
    const std::vector<PlacedBox> boxes{placed_box(box_near(around, uniform))};
    std::vector<Contact> contacts;
    find_soft_rigid(world, boxes, 0, 0, columns, contacts);
    expect_all_contacts(world, boxes[0], contacts);
    if (testing::Test::HasFatalFailure()) FAIL() << "box " << i;
    if (!overlap(around, boxes[0].bounds)) {
      ASSERT_TRUE(contacts.empty()) << i;
      ++without;
    }
    for (const Contact& contact : contacts) {
      ++(contact.first.kind == SideKind::soft ? of_vertices : of_corners);
    }
  }
  EXPECT_GT(of_vertices, 5'000);
  EXPECT_GT(of_corners, 5'000);
  EXPECT_GT(without, 500);
}

TEST(OrientedBox, HasEightCornersByTheirNumbers) {
  Uniform uniform(5);
  for (int i = 0; i < 1'000; ++i) {
    const OrientedBox box = placed_box(box_near({-Vec3::Ones(), Vec3::Ones()}, uniform)).box;
    for (int corner = 0; corner < 8; ++corner) {
      ASSERT_LT((corners(box)[at(corner)] - box.corner(corner)).norm(), 1e-14);
    }
  }
}

TEST(PlacedBox, HasTheBoundsOfItsCorners) {
  Uniform uniform(4);
  for (int i = 0; i < 1'000; ++i) {
    const PlacedBox placed = placed_box(box_near({-Vec3::Ones(), Vec3::Ones()}, uniform));
    Bounds expected;
    for (int corner = 0; corner < 8; ++corner) expected.include(placed.box.corner(corner));
    ASSERT_LT((placed.bounds.low - expected.low).norm(), 1e-14);
    ASSERT_LT((placed.bounds.high - expected.high).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace pneuma::sim
