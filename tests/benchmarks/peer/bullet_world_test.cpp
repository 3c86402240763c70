// The peer simulates what ours does: the same weight, gas, ground and boxes.
#include "benchmarks/peer/bullet_world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "support/worlds.h"

namespace pneuma::benchmarks {
namespace {

TEST(BulletWorld, FallsAsFast) {
  sim::World world = sim::make_free_world(sim::make_body(sim::make_sphere(3.0, 8, 8)));
  world.settings.gravity = {0.0, 0.0, -9.81};
  world.soft[0].material.n = 0.0;
  world.soft[0].material.rho_g = 0.0;
  BulletWorld peer(world);
  for (int i = 0; i < 60; ++i) peer.step();
  EXPECT_NEAR(peer.mean_velocity(0).z(), -9.81, 0.001);  // single precision over sixty steps
}

TEST(BulletWorld, TheGasPushesAsHard) {
  sim::World world = sim::make_free_world(sim::make_body(sim::make_icosphere(3.0, 2)));
  world.settings.integrator = sim::Integrator::symplectic_euler;  // Bullet's
  world.soft[0].material.k = 0.0;
  world.soft[0].material.n = 0.05;
  const auto volume = [&] {
    return sim::volume(world.soft[0].mesh->topology, world.soft[0].positions);
  };
  const double before = volume();
  BulletWorld peer(world, {.link_stiffness = 1e-6});
  peer.step();  // without pressure: Bullet makes the normals at the end of a step
  peer.step();
  sim::Stepper stepper(world);
  ASSERT_FALSE(stepper.step(world));
  // Bullet pushes a node with the areas of its triangles along one normal, ours with the gradient
  // of the volume: a cosine less at each triangle, 2.6 % in all where they meet at these angles.
  EXPECT_NEAR((peer.volume(0) - before) / (volume() - before), 1.0, 0.04);
}

TEST(BulletWorld, BodiesRestOnTheGroundAndTouchBoxes) {
  sim::World world;
  world.settings.gravity = {0.0, 0.0, -9.81};
  world.soft.push_back(sim::make_body(sim::make_sphere(3.0, 8, 8), {0.0, 0.0, 3.5}));
  world.soft[0].material.n = 1.0;
  sim::RigidBox box;
  box.position = {0.0, 0.0, 8.0};
  world.rigid.push_back(box);
  BulletWorld peer(world);
  std::size_t contacts = 0;
  for (int i = 0; i < 180; ++i) {
    peer.step();
    contacts += peer.contact_count();
  }
  EXPECT_GT(contacts, 180u);
  EXPECT_LT(std::abs(peer.mean_velocity(0).z()), 3.0);  // it has not fallen through for 3 s: 29 m/s
}

/// The paper's sphere, dropped from five metres above the ground.
sim::World dropped_sphere() {
  sim::World world;
  world.settings.gravity = {0.0, 0.0, -9.81};
  world.soft.push_back(sim::make_body(sim::make_sphere(3.0, 8, 8), {0.0, 0.0, 8.0}));
  world.soft[0].material.n = 5.0;
  world.soft[0].material.vertex_mass = 0.35;
  return world;
}

constexpr BulletOptions little_gas{.position_iterations = 2, .gas_fraction = 0.05};

TEST(BulletWorld, ADroppedSphereComesToRestAndKeepsItsShape) {
  const sim::World world = dropped_sphere();
  BulletWorld peer(world, little_gas);
  const double before = peer.volume(0);
  for (int i = 0; i < 600; ++i) peer.step();
  EXPECT_LT(peer.mean_velocity(0).norm(), 0.1);  // with all of the gas: 6.3 m/s
  EXPECT_NEAR(peer.volume(0) / before, 1.0, 0.15);
}

TEST(BulletWorld, TheVoxelSizeTakesEffect) {
  EXPECT_EQ(BulletWorld(dropped_sphere()).voxel_size(), 1.0);  // Bullet's own is 0.25 m
  EXPECT_EQ(BulletWorld(dropped_sphere(), {.voxel_size = 2.0}).voxel_size(), 2.0);
}

/// After `seconds` of steps.
sim::World after(double seconds, const sim::World& world, const BulletOptions& options) {
  BulletWorld peer(world, options);
  for (int i = 0; i < static_cast<int>(60.0 * seconds); ++i) peer.step();
  sim::World end = world;
  peer.copy_state(end);
  return end;
}

double lowest(const sim::World& world) { return sim::bounds(world).low.z(); }

TEST(BulletWorld, SubstepsAreThatOfOneStep) {
  sim::World world = dropped_sphere();
  world.soft[0].material.rho_g = 0.0;
  const auto fallen = [&](int substeps) {
    return 5.0 - lowest(after(0.5, world, {.substeps = substeps, .gas_fraction = 1e-6}));
  };
  // Symplectic Euler falls by g t (t + h) / 2, h being the substep.
  EXPECT_NEAR(fallen(1), 0.5 * 9.81 * 0.5 * (0.5 + 1.0 / 60.0), 0.001);
  EXPECT_NEAR(fallen(4), 0.5 * 9.81 * 0.5 * (0.5 + 1.0 / 240.0), 0.001);
}

TEST(BulletWorld, SoftLinksLetTheGasInflateABody) {
  const auto volume = [](double stiffness) { return BulletOptions{.link_stiffness = stiffness}; };
  sim::World world = sim::make_free_world(dropped_sphere().soft[0]);
  const auto end = [&](double stiffness) {
    const sim::World at_end = after(3.0, world, volume(stiffness));
    return sim::volume(at_end.soft[0].mesh->topology, at_end.soft[0].positions);
  };
  EXPECT_GT(end(0.05), 1.5 * end(1.0));
}

TEST(BulletWorld, TheMarginKeepsABodyAboveTheGround) {
  const auto height = [](double margin) {
    BulletOptions options = little_gas;
    options.margin = margin;
    return lowest(after(5.0, dropped_sphere(), options));
  };
  EXPECT_NEAR(height(0.5) - height(0.25), 0.25, 0.1);  // a node sinks in by what links press it
}

TEST(BulletWorld, APlaneHoldsABodyAsABoxDoes) {
  BulletOptions options = little_gas;
  const double on_box = lowest(after(5.0, dropped_sphere(), options));
  options.ground = BulletGround::plane;
  EXPECT_NEAR(lowest(after(5.0, dropped_sphere(), options)), on_box, 0.1);
}

TEST(BulletWorld, DragTakesItsFractionInEverySixtiethOfASecond) {
  sim::World world = sim::make_free_world(dropped_sphere().soft[0]);
  world.soft[0].material.rho_g = 0.0;
  for (int v = 0; v < world.soft[0].velocities.size(); ++v) {
    world.soft[0].velocities[v] = sim::Vec3(1.0, 0.0, 0.0);
  }
  for (const int substeps : {1, 2}) {
    BulletWorld peer(world, {.substeps = substeps, .gas_fraction = 1e-6, .drag = 0.02});
    for (int i = 0; i < 60; ++i) peer.step();
    EXPECT_NEAR(peer.mean_velocity(0).x(), std::pow(0.98, 60), 1e-4);
  }
}

TEST(BulletWorld, TellsWhichLibraryItIs) {
  EXPECT_NE(bullet_build().find("libBulletSoftBody"), std::string::npos);
}

}  // namespace
}  // namespace pneuma::benchmarks
