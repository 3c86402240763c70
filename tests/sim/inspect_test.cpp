#include "sim/inspect/inspect.h"

#include <gtest/gtest.h>

#include "sim/inspect/checkpoint.h"
#include "sim/rigid/inertia.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

World mixed_world() {
  SoftBody body = make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 10.0});
  perturb(body, 0.1, 11);
  World world = make_free_world(std::move(body));
  world.settings.gravity = {0.0, 0.0, -9.81};
  RigidBox box;
  box.size = {1.0, 2.0, 3.0};
  box.mass = 5.0;
  box.position = {4.0, 5.0, 6.0};
  box.velocity = {1.0, -2.0, 0.5};
  box.angular_velocity = {0.3, 0.2, -0.7};
  box.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.8, Vec3(1.0, 2.0, 3.0).normalized()));
  world.rigid.push_back(box);
  world.particles.push_back({0, 0, {1, 2, 3}, {4, 5}});
  return world;
}

TEST(Inspect, ARigidBoxesEnergyAndMomentumAreThoseOfItsGrains) {
  // A box as a lattice of point masses at the centres of 40^3 cells: the moments of inertia fall
  // short of the continuum's by 1/40^2.
  World world = mixed_world();
  world.soft.clear();
  const RigidBox& box = world.rigid[0];
  constexpr int cells = 40;
  const double grain = box.mass / (cells * cells * cells);
  double kinetic = 0.0, gravity = 0.0;
  Momentum sum;
  for (int i = 0; i < cells * cells * cells; ++i) {
    const Vec3 cell(i % cells, i / cells % cells, i / cells / cells);
    const Vec3 local =
        ((cell + Vec3::Constant(0.5)) / cells - Vec3::Constant(0.5)).cwiseProduct(box.size);
    const Vec3 arm = box.orientation * local;
    const Vec3 velocity = box.velocity + box.angular_velocity.cross(arm);
    kinetic += 0.5 * grain * velocity.squaredNorm();
    gravity += grain * 9.81 * (box.position + arm).z();
    sum.linear += grain * velocity;
    sum.angular += (box.position + arm).cross(grain * velocity);
  }
  EXPECT_NEAR(energy(world).kinetic / kinetic, 1.0, 1e-3);
  EXPECT_NEAR(energy(world).gravity / gravity, 1.0, 1e-12);  // rounding
  EXPECT_LT((momentum(world).linear - sum.linear).norm(), 1e-10);
  EXPECT_LT((momentum(world).angular - sum.angular).norm() / sum.angular.norm(), 1e-3);
}

TEST(Inspect, SoftMomentumAndKineticEnergyAreTheSumsOverVertices) {
  const World world = mixed_world();
  const SoftBody& body = world.soft[0];
  double kinetic = 0.0;
  Vec3 linear = Vec3::Zero();
  for (int v = 0; v < body.positions.size(); ++v) {
    kinetic += 0.5 * body.material.vertex_mass * body.velocities[v].squaredNorm();
    linear += body.material.vertex_mass * body.velocities[v];
  }
  EXPECT_NEAR(energy(body, Vec3::Zero()).kinetic, kinetic, 1e-13);
  EXPECT_LT((momentum(body).linear - linear).norm(), 1e-13);
}

TEST(Inspect, BoundsOfATurnedBoxAreThoseOfItsCorners) {
  World world = mixed_world();
  world.soft.clear();
  const RigidBox& box = world.rigid[0];
  Bounds corners;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
    corners.include(Vec3(box.position + box.orientation * sign.cwiseProduct(box.size)));
  }
  EXPECT_LT((bounds(world).low - corners.low).norm(), 1e-14);
  EXPECT_LT((bounds(world).high - corners.high).norm(), 1e-14);
}

TEST(Inspect, AnyChangeOfStateChangesTheHash) {
  const World world = by_impulses(mixed_world());  // swept contacts only show particles
  const std::uint64_t hash = state_hash(world);
  EXPECT_EQ(state_hash(World(world)), hash);
  const auto changed = [&](const auto& change) {
    World other = world;
    change(other);
    return state_hash(other) != hash;
  };
  EXPECT_TRUE(changed([](World& w) { w.soft[0].positions[57].x() += 1e-15; }));
  EXPECT_TRUE(changed([](World& w) { w.soft[0].velocities[0].z() *= -1.0; }));
  EXPECT_TRUE(changed([](World& w) { w.rigid[0].orientation.coeffs() *= -1.0; }));
  EXPECT_TRUE(changed([](World& w) { w.rigid[0].angular_velocity.y() = 0.0; }));
  EXPECT_TRUE(changed([](World& w) { w.particles[0].second_features[1] = 6; }));
  EXPECT_TRUE(changed([](World& w) { ++w.steps; }));
}

TEST(Checkpoint, BringsTheWholeStateBack) {
  World world = mixed_world();
  world.soft.push_back(make_body(make_sphere(3.0, 8, 8)));
  world.particles = {{0, 1, {1, 2, 3}, {4, 5}}};
  world.steps = 42;
  const auto bytes = save_state(world);
  World other = world;
  other.steps = 0;
  other.particles.clear();
  other.soft[0].positions.rows().setZero();
  other.rigid[0].velocity.setZero();
  load_state(bytes, other);
  EXPECT_EQ(state_hash(other), state_hash(world));
  EXPECT_EQ(other.steps, 42);
}

TEST(Checkpoint, WithoutParticlesInAPairIsRefused) {
  World world = mixed_world();
  world.soft.push_back(make_body(make_sphere(3.0, 8, 8)));
  world.particles = {{0, 1, {1, 2, 3}, {}}};
  World other = world;
  EXPECT_THROW(load_state(save_state(world), other), CheckpointError);
}

TEST(Checkpoint, DamagedBytesAreRefusedAndChangeNothing) {
  World world = mixed_world();
  world.particles.clear();
  world.rest = {{3, -1}, {40, 1}};
  world.warm_start_impulses.push_back({0, -1, {0.5, 1.0, -1.5}, {0.1, 0.0, 0.8}, true});
  world.friction_slips.push_back(
      {0, 1, {FeatureKind::edge, 7}, {FeatureKind::vertex, 3}, {1e-4, -2e-4, 0.0}});
  world.feature_impulses.push_back(
      {0, 1, {FeatureKind::edge, 7}, {FeatureKind::vertex, 3}, {0.1, -0.2, 0.3}, true});
  const auto bytes = save_state(world);
  World other = world;
  other.steps = 7;
  const std::uint64_t before = state_hash(other);
  for (std::size_t cut = 0; cut < bytes.size(); cut += 37) {
    EXPECT_THROW(load_state(std::span(bytes).first(cut), other), CheckpointError);
  }
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    auto damaged = bytes;
    damaged[at] ^= 0x10;
    EXPECT_THROW(load_state(damaged, other), CheckpointError) << "byte " << at;
  }
  World smaller = world;
  smaller.rigid.clear();
  EXPECT_THROW(load_state(bytes, smaller), CheckpointError);
  EXPECT_EQ(state_hash(other), before);
}

TEST(Checkpoint, BodiesThatDoNotExistAreRefused) {
  World world = mixed_world();  // of one soft body and one box
  world.particles.clear();
  const auto is_refused = [&](const auto& change) {
    World changed = world;
    change(changed);
    World loaded = world;
    EXPECT_THROW(load_state(save_state(changed), loaded), CheckpointError);
  };
  for (const auto& boxes : {std::pair(1, -1), {-1, -1}, {0, 1}, {0, -2}}) {
    is_refused([&](World& changed) {
      changed.warm_start_impulses.push_back({.first = boxes.first, .second = boxes.second});
    });
  }
  for (const auto& bodies : {std::pair(-1, 0), {2, -1}, {0, 2}, {0, -2}}) {
    is_refused([&](World& changed) {
      changed.friction_slips.push_back({bodies.first, bodies.second, {}, {}});
    });
    is_refused([&](World& changed) {
      changed.feature_impulses.push_back({bodies.first, bodies.second, {}, {}});
    });
  }
  for (const BodyRest& rest : {BodyRest{-1, -1}, BodyRest{0, 2}, BodyRest{0, -2}}) {
    is_refused([&](World& changed) { changed.rest = {rest, {}}; });
  }
}

}  // namespace
}  // namespace pneuma::sim
