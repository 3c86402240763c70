#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/inspect/inspect.h"
#include "sim/response/contact_impulse.h"
#include "sim/soft/damping.h"
#include "tests/support/worlds.h"

namespace pneuma::sim {
namespace {

World sphere_on_ground(double k, double n, double height) {
  World world;
  world.soft.push_back(make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, height}));
  world.soft[0].material.k = k;
  world.soft[0].material.n = n;
  return world;
}

TEST(Ground, ADroppedSphereFollowsTheParabolaWithDragUntilTouchDown) {
  // The rest shape is no equilibrium under pressure, but internal forces leave the centre alone:
  // dv/dt = -g - gamma v, so z = z0 + (g/gamma^2)(1 - exp(-gamma t)) - (g/gamma) t.
  World world = sphere_on_ground(50.0, 1.0, 40.0);
  const double gamma = drag_rate(world.soft[0].material);
  Stepper stepper(world);
  const double start = mean(world.soft[0].positions).z();
  int steps = 0;
  while (true) {
    ASSERT_FALSE(stepper.step(world));
    if (!stepper.contacts().empty()) break;
    const double t = time(world);
    const double expected =
        start + g / (gamma * gamma) * (1.0 - std::exp(-gamma * t)) - g / gamma * t;
    // rk4 on this linear equation errs by (gamma h)^5 / 120 of g / gamma^2 = 27 m a step: 2.3e-11
    // m.
    ASSERT_NEAR(mean(world.soft[0].positions).z(), expected, 2.3e-11 * (steps + 2));
    ++steps;
  }
  EXPECT_GT(steps, 100);
}

/// A sphere on a slope of `degrees` (gravity tilts about y). Being a membrane, it rolls until it
/// has found a face to lie on, in the first 30 s; returns how far and how fast it moves after that.
struct Slide {
  double distance, speed;
};
Slide slide(double degrees, double mu, double seconds) {
  World world = sphere_on_ground(50.0, 10.0, 4.0);
  world.soft[0].material.surface.friction = mu;
  world.settings.ground->friction = mu;
  const double angle = degrees * std::numbers::pi / 180.0;
  world.settings.gravity = {g * std::sin(angle), 0.0, -g * std::cos(angle)};
  EXPECT_FALSE(run(world, 40.0));
  const double before = mean(world.soft[0].positions).x();
  EXPECT_FALSE(run(world, seconds));
  return {mean(world.soft[0].positions).x() - before, mean(world.soft[0].velocities).x()};
}

TEST(Ground, ASphereSticksBelowTheAngleOfFriction) {
  const double mu = 0.1;
  const double limit = std::atan(mu) * 180.0 / std::numbers::pi;  // 5.7 degrees
  for (const double share : {0.5, 0.8, 0.95}) {
    // What is left is the end of its rocking: sliding would make it metres.
    EXPECT_NEAR(slide(share * limit, mu, 20.0).distance, 0.0, 5e-3) << share;
  }
}

TEST(Ground, ASphereSlidesAboveTheAngleOfFriction) {
  // With all the weight on the ground, dv/dt = g (sin - mu cos) - gamma v: the terminal speed
  // follows.
  const double mu = 0.1, gamma = drag_rate(SoftMaterial{});
  for (const double degrees : {8.0, 12.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const double terminal = g * (std::sin(angle) - mu * std::cos(angle)) / gamma;
    // What is left of the start is exp(-gamma 40 s) and the rocking.
    EXPECT_NEAR(slide(degrees, mu, 10.0).speed / terminal, 1.0, 0.002) << degrees;
  }
}

TEST(Ground, RestIsRest) {
  // At rest the vertices above the foot still sway in the foot's rhythm of landing once a step, by
  // micrometres; at 20 kg, 1e-3 J is a speed of a centimetre a second.
  World world = sphere_on_ground(50.0, 10.0, 6.0);
  ASSERT_FALSE(run(world, 40.0));
  const VertexArray before = world.soft[0].positions;
  ASSERT_FALSE(run(world, 20.0));
  EXPECT_LT(energy(world).kinetic, 1e-3) << "joule";
  EXPECT_LT((world.soft[0].positions.rows() - before.rows()).colwise().norm().maxCoeff(), 1e-3);
  EXPECT_EQ(max_penetration(world), 0.0);
}

TEST(Ground, VerticesThatOthersCanTouchTooStayAboveIt) {
  // Two balls that meet as they hit the ground at 10 m/s: 0.17 m in a step, of which a vertex
  // cannot rise further than what may touch it was looked for.
  World world;
  for (const double side : {-1.0, 1.0}) {
    SoftBody ball = make_body(make_sphere(1.5, 8, 8), {1.65 * side, 0.0, 4.0});
    ball.material.k = 200.0;
    ball.material.n = 0.1;
    ball.material.vertex_mass = 0.05;
    ball.velocities.rows().colwise() += Eigen::Vector4d{-side, 0.0, -8.0, 0.0};
    world.soft.push_back(std::move(ball));
  }
  Stepper stepper(world);
  double lowest = 0.0;
  while (time(world) < 2.0) {
    ASSERT_FALSE(stepper.step(world));
    for (const SoftBody& ball : world.soft) {
      lowest = std::min(lowest, ball.positions.rows().row(2).minCoeff());
    }
  }
  EXPECT_GT(lowest, -0.01);
}

TEST(Ground, VerticesBounceWithTheRestitution) {
  // Nothing but the ground acts, so a vertex comes back with epsilon times its speed.
  for (const double epsilon : {0.0, 0.4, 1.0}) {
    SoftBody body = make_body(make_sphere(3.0, 8, 8), {0.0, 0.0, 3.05});
    body.material.k = 0.0;
    body.material.n = 0.0;
    body.material.rho_g = 0.0;
    body.material.surface = {epsilon, 0.0};
    body.velocities.rows().row(2).setConstant(-6.0);
    World world = make_free_world(std::move(body));
    world.settings.ground = ContactMaterial{0.0, 0.0};
    ASSERT_FALSE(run(world, 1.0 / 60.0));
    EXPECT_NEAR(world.soft[0].velocities[57].z(), 6.0 * epsilon, 1e-14);
    EXPECT_EQ(world.soft[0].velocities[0].z(), -6.0) << "the upper pole is in the air";
    EXPECT_NEAR(world.soft[0].positions[57].z(), 0.05 * epsilon, 1e-14)
        << "it met at half the step";
  }
}

TEST(Ground, FrictionIsCoulombs) {
  // One vertex meets the ground at 45 degrees: the normal impulse is m v_n (1 + epsilon).
  World world = sphere_on_ground(0.0, 0.0, 3.0);
  SoftBody& body = world.soft[0];
  const auto meet = [&](double sliding, double mu) {
    body.material.surface = {0.0, mu};
    world.settings.ground = ContactMaterial{0.0, mu};
    body.velocities[57] = Vec3(sliding, 0.0, -2.0);
    const Contact contact{
        {SideKind::soft, 0, {FeatureKind::vertex, 57}}, {}, {0, 0, 0}, Vec3::UnitZ(), 0.0};
    double work = 0.0;
    ContactImpulse impulse(world, {}, contact, 2.0, work);
    impulse.correct();
    EXPECT_NEAR(impulse.impulse().normal, body.material.vertex_mass * 2.0, 1e-15);
    EXPECT_EQ(body.velocities[57].z(), 0.0);
    return body.velocities[57].x();
  };
  EXPECT_NEAR(meet(3.0, 0.5), 3.0 - 0.5 * 2.0, 1e-15) << "slides on";
  EXPECT_NEAR(meet(0.9, 0.5), 0.0, 1e-15) << "stops, never turns back";
  EXPECT_EQ(meet(3.0, 0.0), 3.0) << "no friction";
  EXPECT_EQ(meet(0.0, 0.5), 0.0) << "no direction to slide in, no NaN";
}

struct Shape {
  double height_over_width, foot_over_width;
};
/// The foot is the extent along x of the vertices that stand on the ground.
Shape shape(const SoftBody& body) {
  Bounds foot;
  for (int v = 0; v < body.positions.size(); ++v) {
    if (body.positions[v].z() == 0.0) foot.include(Vec3(body.positions[v]));
  }
  const Vec3 size = bounds(body.positions).size();
  return {size.z() / size.x(), foot.size().x() / size.x()};
}

TEST(Figures, TheSoftSphereSagsAndTheFirmOneIsRound) {
  World soft = sphere_on_ground(10.0, 1.0, 5.0);  // figure 6.4 right
  soft.soft[0].material.vertex_mass = 0.36;
  ASSERT_FALSE(run(soft, 15.0));
  EXPECT_GT(shape(soft.soft[0]).height_over_width, 0.78);
  EXPECT_LT(shape(soft.soft[0]).height_over_width, 0.88);
  EXPECT_GT(shape(soft.soft[0]).foot_over_width, 0.5);
  EXPECT_LT(shape(soft.soft[0]).foot_over_width, 0.7);

  World firm = sphere_on_ground(150.0, 100.0, 5.0);  // figure 6.4 left
  firm.soft[0].material.temperature = 4.4;
  ASSERT_FALSE(run(firm, 15.0));
  EXPECT_GT(shape(firm.soft[0]).height_over_width, 0.95);
  EXPECT_LT(shape(firm.soft[0]).height_over_width, 1.10);
}

}  // namespace
}  // namespace pneuma::sim
