// What the solver of swept contacts solves for together.
#include "sim/step/swept/swept_solver.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/mesh/primitives.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

/// A ball with points on the ground, which they must leave at a speed (m/s) or faster.
class BallOnGround {
 public:
  BallOnGround() : world_(make_world_of_a_ball()), bodies_(world_), solver_(bodies_) {
    bodies_.begin_at_end(world_);
    contacts_.reserve(3);
    impulses_.reserve(3);
  }

  void add_vertex(int vertex, double speed) {
    add({FeatureKind::vertex, vertex}, {1.0, 0.0, 0.0}, speed);
  }
  void add_middle_of_edge(int edge, double speed) {
    add({FeatureKind::edge, edge}, {0.5, 0.5, 0.0}, speed);
  }
  void solve(std::size_t first_new) { solver_.solve(contacts_, impulses_, 1e-9, first_new); }

  const MeshTopology& topology() const { return world_.soft.front().mesh->topology; }
  double impulse(std::size_t contact) const { return impulses_[contact].normal_impulse(); }
  double vertex_mass() const { return world_.soft.front().material.vertex_mass; }
  int island(std::size_t contact) {
    return solver_.island_of(contacts_[contact], impulses_[contact]);
  }
  int islands() const { return solver_.island_count(); }

 private:
  static World make_world_of_a_ball() {
    World world;
    world.soft.push_back(make_body(make_icosphere(1.0, 1)));
    return world;
  }

  void add(const Feature& feature, const FeatureWeights& weights, double speed) {
    SweptContact contact;
    contact.first = {0, feature, weights, Vec3::Zero()};
    contact.second.body = swept_ground;
    contact.normal = Vec3::UnitZ();
    contacts_.push_back(contact);
    impulses_.emplace_back(bodies_.side(world_, contact.first), SweptSide(), contact.normal, 0.0);
    impulses_.back().aim(speed, Vec3::Zero());
  }

  World world_;
  SweptBodies bodies_;
  SweptSolver solver_;
  std::vector<SweptContact> contacts_;
  std::vector<SweptImpulse> impulses_;
};

/// Its springs do not act before all impulses are known.
TEST(SweptSolver, LeavesAloneWhatHasNoVertexInCommonWithANewContact) {
  BallOnGround ball;
  ball.add_vertex(0, 1.0);
  ball.add_vertex(5, 1.0);
  ball.solve(1);
  EXPECT_EQ(ball.islands(), 1);
  EXPECT_EQ(ball.island(0), ball.island(1));
  EXPECT_EQ(ball.impulse(0), 0.0);
  EXPECT_GT(ball.impulse(1), 0.0);
}

/// When one end of an edge leaves at 3 m/s, its middle leaves at 1.5 m/s by itself.
TEST(SweptSolver, SolvesAgainForWhatHasOne) {
  BallOnGround ball;
  ball.add_middle_of_edge(0, 1.0);
  ball.solve(0);
  EXPECT_GT(ball.impulse(0), 0.0);
  ball.add_vertex(ball.topology().edges()[0][0], 3.0);
  ball.solve(1);
  EXPECT_EQ(ball.impulse(0), 0.0);
  EXPECT_NEAR(ball.impulse(1), 3.0 * ball.vertex_mass(), 1e-9);
}

/// Cubes on each other and on the ground, all of which fall at 1 m/s.
class FallingTower {
 public:
  explicit FallingTower(int cubes) : world_(make_world(cubes)), bodies_(world_), solver_(bodies_) {
    bodies_.begin_at_end(world_);
    for (int i = 0; i < cubes; ++i) {
      for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) add(i, {x, y, 2.0 * i});
      }
    }
  }

  /// Returns by how much, m/s, a correction more would change a velocity at most.
  double left_after_solving(double tolerance) {
    solver_.solve(contacts_, impulses_, tolerance);
    double greatest = 0.0;
    for (SweptImpulse& impulse : impulses_) greatest = std::max(greatest, impulse.correct());
    return greatest;
  }

 private:
  static World make_world(int cubes) {
    World world;
    for (int i = 0; i < cubes; ++i) {
      world.rigid.push_back(make_rigid({2.0, 2.0, 2.0}, {0.0, 0.0, 1.0 + 2.0 * i}, 1.0));
    }
    return world;
  }

  void add(int cube, const Vec3& point) {
    SweptContact contact;
    contact.first = {cube, {}, {}, point};
    contact.second = {cube == 0 ? swept_ground : cube - 1, {}, {}, point};
    contact.normal = Vec3::UnitZ();
    contacts_.push_back(contact);
    impulses_.emplace_back(bodies_.side(world_, contact.first),
                           bodies_.side(world_, contact.second), contact.normal, 0.0);
    impulses_.back().aim(cube == 0 ? 1.0 : 0.0, Vec3::Zero());
  }

  World world_;
  SweptBodies bodies_;
  SweptSolver solver_;
  std::vector<SweptContact> contacts_;
  std::vector<SweptImpulse> impulses_;
};

TEST(SweptSolver, LeavesAHundredthOfTheToleranceBetweenBoxes) {
  constexpr double tolerance = 2e-3;
  EXPECT_LT(FallingTower(30).left_after_solving(tolerance), 0.01 * tolerance);
}

}  // namespace
}  // namespace pneuma::sim
