// The paper's method as printed (ERRATA row 68).
#include "sim/world/paper_method.h"

#include <gtest/gtest.h>

#include "sim/collision/bounding_sphere.h"
#include "sim/collision/feature_contact.h"
#include "sim/inspect/inspect.h"
#include "sim/response/printed_response.h"
#include "sim/rigid/rigid_motion.h"
#include "tests/sim/contact_worlds.h"

namespace pneuma::sim {
namespace {

World as_printed(World world) {
  use_paper_method(world);
  return world;
}

World everything() {
  World world;
  add(world, torus(7.0, {0.0, 0.0, 2.6}));
  add(world, sphere({0.0, 0.0, 6.5}));
  add(world, sphere({1.0, 0.5, 13.0}));
  add(world, make_rigid({2.0, 2.0, 2.0}, {7.0, 0.3, 7.0}));
  add(world, make_rigid({2.0, 2.0, 2.0}, {7.3, 0.1, 9.5}));
  return as_printed(world);
}

TEST(PaperMethod, SetsThePapersIntegratorWeightsDampingAndContacts) {
  World world;
  world.settings.skin_thickness = 0.1;
  world.settings.particles.max_sweeps = 3;
  world.settings.contact = ContactMethod::swept;
  add(world, sphere({0.0, 0.0, 3.0}));
  use_paper_method(world);
  const Settings& settings = world.settings;
  EXPECT_TRUE(is_as_printed(settings));
  EXPECT_EQ(settings.integrator, Integrator::martin);
  EXPECT_EQ(settings.contact, ContactMethod::impulses);
  EXPECT_EQ(settings.skin_thickness, 0.5);
  EXPECT_EQ(settings.particles.max_sweeps, 10);
  EXPECT_EQ(settings.relaxation_time, 0.0);
  EXPECT_EQ(settings.contact_iterations, 1);
  EXPECT_EQ(world.soft[0].material.pressure_weighting, PressureWeighting::valence);
  EXPECT_EQ(world.soft[0].material.damping, Damping::literal);
  EXPECT_EQ(settings.steps_per_second, Settings{}.steps_per_second);
}

TEST(PaperMethod, MovesNoBodiesApartAsWholes) {
  World world = by_impulses();
  add(world, sphere({0.0, 0.0, 3.0}));
  add(world, sphere({7.0, 0.0, 3.0}));
  EXPECT_TRUE(make_plan(world).runs(Stage::depenetrate));
  EXPECT_FALSE(make_plan(as_printed(world)).runs(Stage::depenetrate));
}

StepperOptions on_threads(int threads) {
  StepperOptions options;
  options.threads = threads;
  return options;
}

TEST(PaperMethod, ComesToTheSameForEveryNumberOfThreads) {
  World one = everything(), three = everything();
  EXPECT_FALSE(run(one, 3.0, on_threads(1)));
  EXPECT_FALSE(run(three, 3.0, on_threads(3)));
  EXPECT_EQ(state_hash(one), state_hash(three));
  World corrected = everything();
  corrected.settings.method = Method::corrected;
  EXPECT_FALSE(run(corrected, 3.0));
  EXPECT_NE(state_hash(one), state_hash(corrected));
}

TEST(PaperMethod, StepsOfABodyAloneAreThoseOfItsSwitches) {
  World printed = as_printed(make_free_world(make_body(make_sphere(3.0, 8, 8))));
  World switched = printed;
  switched.settings.method = Method::corrected;
  EXPECT_FALSE(run(printed, 1.0));
  EXPECT_FALSE(run(switched, 1.0));
  EXPECT_EQ(state_hash(printed), state_hash(switched));
}

/// Euler-Cromer from rest: after n steps p = g h^2 n (n + 1) / 2.
TEST(PrintedBox, MovesWithTheVelocityOfTheStepsEnd) {
  RigidBox box = make_rigid({1.0, 2.0, 3.0}, {0.0, 0.0, 0.0});
  box.rho_g = 0.0;
  box.angular_velocity = {0.3, 0.2, 0.1};
  for (int i = 0; i < 10; ++i) move_as_printed(box, {0.0, 0.0, -8.0}, 0.25);
  EXPECT_NEAR(box.position.z(), -8.0 * 0.0625 * 55.0, 1e-12);
  EXPECT_EQ(box.angular_velocity, Vec3(0.3, 0.2, 0.1));  // though no cube
  box.rho_g = 0.25;
  box.velocity = {4.0, 0.0, 0.0};
  move_as_printed(box, Vec3::Zero(), 1.0 / 240.0);
  EXPECT_EQ(box.velocity.x(), 3.0);  // of each step, whatever its length
}

TEST(PrintedFriction, TakesTheImpulseForAVelocity) {
  const Vec3 up = Vec3::UnitZ();
  const Vec3 change = printed_friction({3.0, 4.0, 1.0}, up, 0.5, 2.0);
  EXPECT_NEAR((change - Vec3(-0.6, -0.8, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_GT(printed_friction({-0.1, 0.0, 0.0}, up, 1.0, 5.0).x(), 0.1);  // turns the sliding
  EXPECT_EQ(printed_friction({3.0, 4.0, 1.0}, up, 0.5, -2.0).norm(), 0.0);
  EXPECT_EQ(printed_friction({0.0, 0.0, -2.0}, up, 0.5, 2.0).norm(), 0.0);
}

TEST(PrintedImpulse, PartsFeaturesOnceWithTheRestitution) {
  World world = as_printed(meeting_spheres(3.0, 1));
  for (SoftBody& body : world.soft) body.material.surface.restitution = 0.5;
  const Contact contact{{SideKind::soft, 0, {FeatureKind::triangle, 5}},
                        {SideKind::soft, 1, {FeatureKind::vertex, 7}},
                        Vec3::Zero(),
                        -Vec3::UnitX()};
  std::vector contacts = {contact};
  const Vec3 momentum_before = momentum(world).linear;
  apply_printed_impulses(world, {}, contacts);
  const SolverSide first(world, {}, contact.first, contact.point);
  const SolverSide second(world, {}, contact.second, contact.point);
  EXPECT_NEAR(first.velocity()[0] - second.velocity()[0], -0.5 * 6.0, 1e-12);
  EXPECT_NEAR((momentum(world).linear - momentum_before).norm(), 0.0, 1e-12);
  const std::uint64_t parted = state_hash(world);
  apply_printed_impulses(world, {}, contacts);  // j is never negative
  EXPECT_EQ(state_hash(world), parted);
}

TEST(PrintedImpulse, PullsBoxesThatPartBackTogether) {
  World world = as_printed(
      make_free_boxes({make_rigid({2, 2, 2}, {0, 0, 0}), make_rigid({2, 2, 2}, {1.9, 0, 0})}, 0.0));
  world.rigid[1].velocity = {4.0, 0.0, 0.0};
  const std::vector<BoxMass> masses = {box_mass(world.rigid[0]), box_mass(world.rigid[1])};
  const Contact contact{
      {SideKind::rigid, 0, {}}, {SideKind::rigid, 1, {}}, {0.95, 0, 0}, -Vec3::UnitX(), 0.1};
  std::vector contacts = {contact};
  apply_printed_impulses(world, masses, contacts);
  EXPECT_NEAR(world.rigid[0].velocity.x(), 2.0, 1e-12);
  EXPECT_NEAR(world.rigid[1].velocity.x(), 2.0, 1e-12);
}

TEST(PrintedSeparation, MovesTheVertexAloneByTheDepth) {
  World world = as_printed(meeting_spheres(0.0, 1));
  const Vec3 vertex = world.soft[1].positions[7];
  const VertexArray triangle_body = world.soft[0].positions;
  const Contact contact{{SideKind::soft, 0, {FeatureKind::triangle, 5}},
                        {SideKind::soft, 1, {FeatureKind::vertex, 7}},
                        Vec3::Zero(),
                        -Vec3::UnitX(),
                        0.5};
  separate_as_printed(world, {}, std::vector{contact});
  EXPECT_NEAR((Vec3(world.soft[1].positions[7]) - vertex - Vec3(0.5, 0.0, 0.0)).norm(), 0.0, 1e-15);
  for (int v = 0; v < triangle_body.size(); ++v) {
    EXPECT_EQ(Vec3(world.soft[0].positions[v]), Vec3(triangle_body[v]));
  }
}

TEST(PrintedSphere, ReachesTheCornersOfTheBoundingBox) {
  const BoundingSphere sphere = printed_bounding_sphere({{-1.0, -2.0, 0.0}, {1.0, 2.0, 4.0}});
  EXPECT_EQ(sphere.centre, Vec3(0.0, 0.0, 2.0));
  EXPECT_NEAR(sphere.radius, 3.0, 1e-15);
}

/// Each contact that the printed tests find is one, at two points of the features; some they miss.
TEST(PrintedContact, IsNeverNearerThanTheNearestPointsAndSometimesMissed) {
  SoftBody a = make_body(make_sphere(3.0, 6, 6)), b = make_body(make_torus(3.0, 1.0, 6, 6));
  perturb(a, 0.3, 1);
  perturb(b, 0.3, 2);
  for (int v = 0; v < b.positions.size(); ++v) b.positions[v] += Vec3(3.0, 1.0, 2.0);
  const SurfaceView first{a.mesh->topology, a.positions}, second{b.mesh->topology, b.positions};
  int found = 0, missed = 0;
  for (int i = 0; i < first.topology.feature_count(); ++i) {
    for (int j = 0; j < second.topology.feature_count(); ++j) {
      const Feature one = first.topology.feature(i), other = second.topology.feature(j);
      const auto printed = find_printed_contact(first, one, second, other, 1.0);
      const auto nearest = find_feature_contact(first, one, second, other, 1.0);
      if (!printed) {
        missed += nearest ? 1 : 0;
        continue;
      }
      ++found;
      ASSERT_TRUE(nearest);
      EXPECT_GE(printed->distance, nearest->distance - 1e-12);
      EXPECT_LT(printed->distance, 1.0);
      EXPECT_NEAR((printed->first_point - printed->second_point).norm(), printed->distance, 1e-12);
      EXPECT_NEAR(printed->normal.norm(), 1.0, 1e-12);
    }
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(missed, 0);
}

TEST(PrintedContact, OfAnEdgeHasANormalBetweenThoseOfItsEnds) {
  SoftBody body = make_body(make_sphere(3.0, 6, 6));
  perturb(body, 0.3, 1);
  const SurfaceView surface{body.mesh->topology, body.positions};
  const auto& [a, b] = surface.topology.edges()[4];
  const Vec3 from = surface.positions[a], to = surface.positions[b];
  const auto of_vertex = [&](int v) {
    return printed_normal(surface, {FeatureKind::vertex, v}, Vec3::Zero());
  };
  const Feature edge{FeatureKind::edge, 4};
  EXPECT_NEAR((printed_normal(surface, edge, from) - of_vertex(a)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((printed_normal(surface, edge, to) - of_vertex(b)).norm(), 0.0, 1e-12);
  const Vec3 middle = (of_vertex(a) + of_vertex(b)).normalized();
  EXPECT_NEAR((printed_normal(surface, edge, 0.5 * (from + to)) - middle).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace pneuma::sim
