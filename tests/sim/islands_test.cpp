// Islands of contacts, against a search through all pairs of them; vertices alone on the
// ground, against the impulses of all other contacts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <set>

#include "sim/response/contact_islands.h"
#include "sim/response/vertex_on_ground.h"
#include "tests/sim/random_contacts.h"

namespace pneuma::sim {
namespace {

/// What a contact has in common with others: vertices and boxes as (kind, body, number).
using Nodes = std::set<std::array<int, 3>>;

Nodes nodes(const World& world, const Contact& contact) {
  Nodes result;
  for (const ContactSide& side : {contact.first, contact.second}) {
    if (side.kind == SideKind::rigid) result.insert({1, side.body, 0});
    if (side.kind != SideKind::soft) continue;
    for (const int v : world.soft[at(side.body)].mesh->topology.feature_vertices(side.feature)) {
      result.insert({0, side.body, v});
    }
  }
  return result;
}

bool have_common(const Nodes& a, const Nodes& b) {
  return std::any_of(a.begin(), a.end(), [&b](const auto& node) { return b.count(node) > 0; });
}

/// The lowest number of all contacts that each hangs together with, by going round until nothing
/// changes.
std::vector<int> lowest_in_island(const World& world, const std::vector<Contact>& contacts) {
  std::vector<Nodes> all;
  for (const Contact& contact : contacts) all.push_back(nodes(world, contact));
  std::vector<int> lowest(contacts.size());
  std::iota(lowest.begin(), lowest.end(), 0);
  for (bool changes = true; changes;) {
    changes = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < all.size(); ++j) {
        if (lowest[j] >= lowest[i] || !have_common(all[i], all[j])) continue;
        lowest[i] = lowest[j];
        changes = true;
      }
    }
  }
  return lowest;
}

class RandomIslands {
 public:
  explicit RandomIslands(unsigned seed) : random_(seed) {
    for (int i = 0; i < 4; ++i) world_.soft.push_back(make_body(make_sphere(1.0, 4, 5)));
    world_.rigid.resize(6);
  }

  const World& world() const { return world_; }

  /// As they are found: vertices on the ground first, each at most once.
  std::vector<Contact> contacts() {
    std::vector<Contact> result;
    const int vertices = world_.soft[0].positions.size();
    for (int body = 0; body < 4; ++body) {
      for (int v = 0; v < vertices; ++v) {
        if (below(4) == 0) {
          result.push_back({{SideKind::soft, body, {FeatureKind::vertex, v}}, {}});
        }
      }
    }
    const int others = below(12);
    for (int i = 0; i < others; ++i) {
      ContactSide second = side();
      if (below(4) == 0) second = {};
      ContactSide first = side();
      while (first.kind == SideKind::soft && second.kind == SideKind::ground) first = side();
      result.push_back({first, second});
    }
    return result;
  }

 private:
  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  ContactSide side() {
    if (below(2) == 0) return {SideKind::rigid, below(6), {}};
    const MeshTopology& mesh = world_.soft[0].mesh->topology;
    return {SideKind::soft, below(4), mesh.feature(below(mesh.feature_count()))};
  }

  World world_;
  std::mt19937_64 random_;
};

TEST(ContactIslands, AreWhatHangsTogether) {
  RandomIslands random(1);
  ContactIslands islands(random.world());
  int shared_vertices = 0, large = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const std::vector<Contact> contacts = random.contacts();
    const std::vector<int> lowest = lowest_in_island(random.world(), contacts);
    islands.divide(contacts);

    std::vector<int> seen;
    for (const int i : islands.alone()) {
      ASSERT_TRUE(is_soft_ground(contacts[at(i)]));
      ASSERT_EQ(std::count(lowest.begin(), lowest.end(), i), 1);
      seen.push_back(i);
    }
    for (int island = 0; island < islands.count(); ++island) {
      const auto members = islands.island(island);
      ASSERT_FALSE(members.empty());
      ASSERT_TRUE(std::is_sorted(members.begin(), members.end())) << "in the order found";
      ASSERT_EQ(members.front(), lowest[at(members.front())]);
      ASSERT_EQ(std::count(lowest.begin(), lowest.end(), members.front()),
                static_cast<std::ptrdiff_t>(members.size()));
      for (const int i : members) ASSERT_EQ(lowest[at(i)], members.front());
      ASSERT_FALSE(members.size() == 1 && is_soft_ground(contacts[at(members.front())]));
      large += members.size() > 3 ? 1 : 0;
      shared_vertices += is_soft_ground(contacts[at(members.front())]) ? 1 : 0;
      seen.insert(seen.end(), members.begin(), members.end());
    }
    std::sort(seen.begin(), seen.end());
    std::vector<int> all(contacts.size());
    std::iota(all.begin(), all.end(), 0);
    ASSERT_EQ(seen, all) << "each contact once";
  }
  EXPECT_GT(large, 100);
  EXPECT_GT(shared_vertices, 100);
}

TEST(ContactIslands, DoNotFeelEachOther) {
  // Two boxes that fall on each other end in the same bits with another heap beside them.
  World alone = by_impulses();
  alone.settings.ground = ContactMaterial{0.3, 0.5};
  alone.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 0.6}));
  alone.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.3, 0.1, 2.0}));
  World crowded = alone;
  for (int i = 0; i < 4; ++i) {
    crowded.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {9.0 + 0.2 * i, 0.1 * i, 0.7 + 1.3 * i}));
  }
  ASSERT_FALSE(run(alone, 2.0));
  ASSERT_FALSE(run(crowded, 2.0));
  for (std::size_t i = 0; i < alone.rigid.size(); ++i) {
    EXPECT_EQ(crowded.rigid[i].position, alone.rigid[i].position);
    EXPECT_EQ(crowded.rigid[i].angular_velocity, alone.rigid[i].angular_velocity);
  }
}

TEST(VertexOnGround, IsWhatTheImpulsesOfAContactComeTo) {
  RandomContacts random(21);
  int bounced = 0, stuck = 0, slid = 0;
  for (int trial = 0; trial < 10'000; ++trial) {
    random.next();
    World& world = random.world();
    SoftBody& body = world.soft[0];
    const int v = trial % body.positions.size();
    const Contact contact{
        {SideKind::soft, 0, {FeatureKind::vertex, v}}, {}, body.positions[v], Vec3::UnitZ()};
    const double start_approach = random.uniform(-5.0, 15.0);
    const ContactMaterial pair = pair_surface(world, contact);
    Vec3 closed_form = body.velocities[v];
    const double speed = closed_form.norm();
    const bool sticks = meet_ground(start_approach, pair, closed_form);

    double work = 0.0;
    ContactImpulse impulse(world, {}, contact, start_approach, work);
    impulse.correct();
    const bool bounces = impulse.bounce();
    if (bounces) impulse.correct();
    // A few roundings of the speed.
    ASSERT_LT((body.velocities[v] - closed_form).norm(), 1e-14 * speed) << trial;
    ASSERT_EQ(sticks, impulse.sticks()) << trial;
    bounced += bounces ? 1 : 0;
    stuck += sticks ? 1 : 0;
    slid += !sticks && impulse.impulse().normal > 0.0 ? 1 : 0;
  }
  EXPECT_GT(bounced, 1000);
  EXPECT_GT(stuck, 300);
  EXPECT_GT(slid, 1000);
}

TEST(VertexOnGround, IsLeftAloneWhenItRises) {
  Vec3 velocity(1.0, 2.0, 3.0);
  EXPECT_FALSE(meet_ground(4.0, {1.0, 1.0}, velocity));
  EXPECT_EQ(velocity, Vec3(1.0, 2.0, 3.0));
  velocity.z() = 0.0;
  EXPECT_FALSE(meet_ground(4.0, {1.0, 1.0}, velocity)) << "nor when it lies still";
  EXPECT_EQ(velocity, Vec3(1.0, 2.0, 0.0));
}

TEST(ContactFriction, DoesNotDependOnWhichWayTheGroundLies) {
  // The same box slides down the same slope, turned about the vertical: the tangents of a contact
  // are turned otherwise than the box.
  const auto slide = [](double turn) {
    World world;
    world.settings.ground = ContactMaterial{0.0, 0.5};
    world.rigid.push_back(make_rigid({1.0, 1.0, 1.0}, {0.0, 0.0, 0.5}));
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
    world.rigid[0].orientation = rotation;
    world.rigid[0].surface = {0.0, 0.5};
    world.settings.gravity = rotation * Vec3(6.0, 0.0, -8.0);
    EXPECT_FALSE(run(world, 2.0));
    return Vec3(rotation.conjugate() * world.rigid[0].velocity);
  };
  const Vec3 straight = slide(0.0);
  EXPECT_GT(straight.x(), 2.0) << "it slides";
  for (const double turn : {0.5, 1.0, 1.5707963267948966, 2.5, 4.0}) {
    // Sweeps end a millionth of the impulses short of what stops the sides.
    EXPECT_LT((slide(turn) - straight).norm(), 1e-3 * straight.norm()) << turn;
  }
}

}  // namespace
}  // namespace pneuma::sim
