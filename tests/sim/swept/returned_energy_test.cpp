// What the contacts of a step may add to the energy.
#include "sim/step/swept/returned_energy.h"

#include <gtest/gtest.h>

#include "sim/mesh/primitives.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

constexpr double tolerance = 1e-9;  // m/s

/// A vertex of a ball that comes to the ground at 1 m/s and must not go on.
class VertexOnGround {
 public:
  VertexOnGround() : world_(make_world_of_a_ball()), memory_(world_) {
    memory_.bodies.begin_at_end(world_);
    SweptContact contact;
    contact.first = {0, {FeatureKind::vertex, 0}, {1.0, 0.0, 0.0}, Vec3::Zero()};
    contact.second.body = swept_ground;
    contact.normal = Vec3::UnitZ();
    memory_.contacts.push_back(contact);
    memory_.impulses.emplace_back(memory_.bodies.side(world_, contact.first), SweptSide(),
                                  contact.normal, 0.0);
    memory_.impulses.back().aim(1.0, Vec3::Zero());
    memory_.end_velocities.push_back(-Vec3::UnitZ());
    memory_.solver.solve(memory_.contacts, memory_.impulses, tolerance);
  }

  /// Of the impulse that stops it.
  double share_after_limit_of(double share) {
    SweptImpulse& impulse = memory_.impulses.front();
    impulse.replace_given(Vec4d{0.0, 0.0, share * vertex_mass(), 0.0});
    limit_returned_energy(memory_, tolerance);
    return impulse.given().z() / vertex_mass();
  }
  double work() const { return memory_.work_of_islands.front(); }
  double vertex_mass() const { return world_.soft.front().material.vertex_mass; }

 private:
  static World make_world_of_a_ball() {
    World world;
    world.soft.push_back(make_body(make_icosphere(1.0, 1)));
    return world;
  }

  World world_;
  SweptMemory memory_;
};

TEST(ReturnedEnergy, ImpulsesThatAddWorkAreShortenedToThoseThatDoLeast) {
  VertexOnGround vertex;
  EXPECT_NEAR(vertex.share_after_limit_of(3.0), 1.0, 1e-12);
  EXPECT_NEAR(vertex.work(), -0.5 * vertex.vertex_mass(), 1e-12);
}

TEST(ReturnedEnergy, ImpulsesThatAddNoWorkStay) {
  VertexOnGround vertex;
  for (const double share : {0.5, 1.0, 1.9}) {
    EXPECT_NEAR(vertex.share_after_limit_of(share), share, 1e-12);
  }
}

}  // namespace
}  // namespace pneuma::sim
