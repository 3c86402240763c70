#include "app/world/build_world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/loader/load_scene.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

scenes::Scene scene_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return scenes::parse_scene(text, "test.toml", overrides);
}

constexpr const char* block_of_spheres = R"(
duration = 1.0
[[body]]
name = "ball"
kind = "soft"
shape = "sphere"
stacks = 4
slices = 4
radius = 0.5
position = [1.0, 2.0, 3.0]
copies = [3, 2, 2]
spacing = [10.0, 20.0, 30.0]
)";

/// A thousand copies at one place, to a few nanometres: a scene may not say at the very same.
constexpr const char* heap = R"(
duration = 1.0
[[body]]
kind = "rigid"
copies = [10, 10, 10]
spacing = [1e-9, 1e-9, 1e-9]
jitter = 2.0
tumble = true
)";

void expect_near(const Vec3& actual, const Vec3& expected, double tolerance) {
  EXPECT_NEAR((actual - expected).norm(), 0.0, tolerance)
      << "is " << actual.transpose() << ", expected " << expected.transpose();
}

// A few roundings of numbers of size 1 to 100.
constexpr double place_rounding = 1e-13;

TEST(BuildWorld, PlacesCopiesXFastestAndNumbersThem) {
  const sim::World world = build_world(scene_of(block_of_spheres));
  ASSERT_EQ(world.soft.size(), 12u);
  EXPECT_EQ(world.soft[0].name, "ball.1");
  EXPECT_EQ(world.soft[11].name, "ball.12");
  expect_near(sim::mean(world.soft[0].positions), {1.0, 2.0, 3.0}, place_rounding);
  expect_near(sim::mean(world.soft[1].positions), {11.0, 2.0, 3.0}, place_rounding);
  expect_near(sim::mean(world.soft[3].positions), {1.0, 22.0, 3.0}, place_rounding);
  expect_near(sim::mean(world.soft[6].positions), {1.0, 2.0, 33.0}, place_rounding);
}

TEST(BuildWorld, LeavesTheNameOfASingleBodyAlone) {
  const sim::World world = build_world(scene_of(block_of_spheres, {"body.copies=[1,1,1]"}));
  ASSERT_EQ(world.soft.size(), 1u);
  EXPECT_EQ(world.soft[0].name, "ball");
}

TEST(BuildWorld, SharesOneMeshBetweenBodiesOfOneShape) {
  const std::string other_body = R"(
[[body]]
kind = "soft"
shape = "sphere"
stacks = 4
slices = 4
k = 7.0
)";
  const sim::World same = build_world(scene_of(block_of_spheres + other_body, {"body.radius=0.5"}));
  for (const sim::SoftBody& body : same.soft) EXPECT_EQ(body.mesh, same.soft[0].mesh);

  const sim::World other = build_world(scene_of(block_of_spheres + other_body));  // radius 3
  EXPECT_NE(other.soft.back().mesh, other.soft[0].mesh);
}

TEST(BuildWorld, HandsOnMaterialAndSettings) {
  const sim::World world = build_world(
      scene_of(block_of_spheres, {"body.k=77", "body.n=5", "simulation.gravity=[0,0,-1]"}));
  EXPECT_EQ(world.soft[0].material.k, 77.0);
  EXPECT_EQ(world.soft[0].material.n, 5.0);
  EXPECT_EQ(world.settings.gravity, Vec3(0.0, 0.0, -1.0));
  EXPECT_EQ(world.steps, 0);
}

TEST(BuildWorld, TurnsAboutWorldXThenYThenZ) {
  const std::string box = R"(
duration = 1.0
[[body]]
kind = "rigid"
position = [1.0, 2.0, 3.0]
)";
  // About x: x stays. About y by -90: x becomes z. About z: z stays. Any other order ends
  // elsewhere.
  const sim::World world = build_world(scene_of(box, {"body.rotation=[90, -90, 90]"}));
  ASSERT_EQ(world.rigid.size(), 1u);
  const Eigen::Quaterniond& turn = world.rigid[0].orientation;
  expect_near(turn * Vec3::UnitX(), Vec3::UnitZ(), place_rounding);
  // About x: y becomes z. About y by -90: z becomes -x. About z: -x becomes -y.
  expect_near(turn * Vec3::UnitY(), -Vec3::UnitY(), place_rounding);
  EXPECT_EQ(world.rigid[0].position, Vec3(1.0, 2.0, 3.0));
}

TEST(BuildWorld, CountsAnglesOnBeyondAWholeTurn) {
  const auto box = [](const std::string& rotation) {
    return build_world(scene_of("[[body]]\nkind = \"rigid\"\nrotation = " + rotation)).rigid.at(0);
  };
  const Eigen::Quaterniond once = box("[10, -20, 30]").orientation;
  EXPECT_LT(box("[370, -380, 750]").orientation.angularDistance(once), 1e-9);
  EXPECT_LT(box("[-710, 340, -330]").orientation.angularDistance(once), 1e-9);
}

TEST(BuildWorld, GivesSoftBodiesTheVelocityOfARigidRotation) {
  const sim::World world = build_world(scene_of(
      block_of_spheres, {"body.copies=[1,1,1]", "body.radius=2.0", "body.velocity=[1.0, 0.0, 0.0]",
                         "body.angular_velocity=[3.0, 0.0, 0.0]"}));
  const sim::SoftBody& body = world.soft[0];
  for (int v = 0; v < body.positions.size(); ++v) {
    const Vec3 arm = Vec3(body.positions[v]) - Vec3(1.0, 2.0, 3.0);
    // (3, 0, 0) x (x, y, z) written out.
    expect_near(body.velocities[v], {1.0, -3.0 * arm.z(), 3.0 * arm.y()}, place_rounding);
  }
}

TEST(BuildWorld, IsTheSameEveryTimeAndAnotherForAnotherSeed) {
  const auto hash = [](const std::vector<std::string>& overrides) {
    return sim::state_hash(build_world(scene_of(heap, overrides)));
  };
  EXPECT_EQ(hash({}), hash({}));
  EXPECT_NE(hash({}), hash({"simulation.seed=2"}));
}

TEST(BuildWorld, LeavesBodiesAsTheyWereWhenOthersAreAdded) {
  const std::string another = "[[body]]\nkind = \"rigid\"\njitter = 1.0\n";
  const sim::World few = build_world(scene_of(heap));
  const sim::World more = build_world(scene_of(heap + another));
  for (std::size_t i = 0; i < few.rigid.size(); ++i) {
    ASSERT_EQ(few.rigid[i].position, more.rigid[i].position) << i;
    ASSERT_EQ(few.rigid[i].orientation.coeffs(), more.rigid[i].orientation.coeffs()) << i;
  }
}

TEST(BuildWorld, JittersUniformlyInABall) {
  const sim::World world = build_world(scene_of(heap));
  Vec3 mean = Vec3::Zero();
  double squared = 0.0;
  for (const sim::RigidBox& box : world.rigid) {
    ASSERT_LE(box.position.norm(), 2.0 + 20e-9);
    mean += box.position / 1000.0;
    squared += box.position.squaredNorm() / 1000.0;
  }
  // In a ball of radius 2 each coordinate has variance 4/5, and r^2 has mean 4 * 3/5 and standard
  // deviation 4 sqrt(3/7 - 9/25) = 1.05. Five standard errors of a mean over 1000.
  expect_near(mean, Vec3::Zero(), 5.0 * std::sqrt(3.0 * 0.8 / 1000.0));
  EXPECT_NEAR(squared, 2.4, 5.0 * 1.05 / std::sqrt(1000.0));
}

TEST(BuildWorld, TumblesUniformly) {
  const sim::World world = build_world(scene_of(heap));
  Vec3 mean = Vec3::Zero();
  sim::Mat3 second = sim::Mat3::Zero();
  for (const sim::RigidBox& box : world.rigid) {
    EXPECT_NEAR(box.orientation.norm(), 1.0, 1e-15);  // the last digit
    const Vec3 axis = box.orientation * Vec3::UnitZ();
    mean += axis / 1000.0;
    second += axis * axis.transpose() / 1000.0;
  }
  // A uniform direction has mean 0 and second moments 1/3, with standard deviations of at most 0.58
  // and 0.3 per entry. Five standard errors of a mean over 1000.
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 5.0 * 0.58 / std::sqrt(1000.0));
  const sim::Mat3 rest = second - sim::Mat3::Identity() / 3.0;
  EXPECT_LT(rest.cwiseAbs().maxCoeff(), 5.0 * 0.3 / std::sqrt(1000.0));
}

/// Shapes that no scene file can ask for, because its ranges do not let them through.
scenes::Scene scene_with(const scenes::BodyScene& body) {
  scenes::Scene scene;
  scene.name = "test";
  scene.bodies.push_back(body);
  return scene;
}

std::string refusal(const scenes::BodyScene& body) {
  try {
    build_world(scene_with(body));
  } catch (const scenes::SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(BuildWorld, NamesKeyAndLineWhereTheSpringsCannotHoldTheShape) {
  const scenes::Scene scene = scenes::parse_scene(
      "[[body]]\n[[body]]\nname = \"weak\"\nrest = \"equilibrium\"\nk = 0\n", "there/weak.toml");
  try {
    build_world(scene);
    ADD_FAILURE();
  } catch (const scenes::SceneError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("there/weak.toml:4:8: body 'weak': rest = \"equilibrium\": "))
        << message;
    EXPECT_NE(message.find("4 | rest = \"equilibrium\"\n"), std::string::npos) << message;
  }
}

TEST(BuildWorld, NamesTheOverrideWithWhichTheSpringsCannotHoldTheShape) {
  const std::vector<std::string> overrides = {"body.rest=equilibrium"};
  const scenes::Scene scene = scenes::parse_scene("[[body]]\n", "there/full.toml", overrides);
  try {
    build_world(scene);
    ADD_FAILURE();
  } catch (const scenes::SceneError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("--set body.rest=equilibrium: body 'body1': ")) << message;
    EXPECT_NE(message.find("at most n = "), std::string::npos) << message;
  }
}

TEST(BuildWorld, RefusesGasWithoutAVolume) {
  scenes::BodyScene body;
  body.name = "inside_out";
  body.shape = scenes::Shape::box;
  body.size = {-1.0, 2.0, 3.0};
  const std::string message = refusal(body);
  EXPECT_NE(message.find("'inside_out'"), std::string::npos) << message;
  EXPECT_NE(message.find("-6"), std::string::npos) << message;

  body.material.n = 0.0;
  EXPECT_EQ(refusal(body), "");
  body.material.n = 1.0;
  body.material.temperature = 0.0;
  EXPECT_EQ(refusal(body), "");
}

TEST(BuildWorld, ABodyWithRestInEquilibriumStaysAsItIsMade) {
  // In free space: with springs at rest in the shape it would be blown up to several times its
  // volume.
  const std::string ball = R"(
[simulation]
gravity = [0.0, 0.0, 0.0]
[ground]
present = false
[[body]]
shape = "icosphere"
k = 100.0
n = 3.0
)";
  const auto volume_after = [&](const std::string& rest) {
    sim::World world = build_world(scene_of(ball, {"body.rest=" + rest}));
    sim::Stepper stepper(world);
    while (world.steps < 300) EXPECT_FALSE(stepper.step(world));
    const sim::SoftBody& body = world.soft[0];
    return sim::volume(body.mesh->topology, body.positions) /
           sim::volume(body.mesh->topology, body.mesh->rest_positions);
  };
  EXPECT_NEAR(volume_after("equilibrium"), 1.0, 0.1);  // but for loads that are left alone
  EXPECT_GT(volume_after("shape"), 2.0);
}

TEST(BuildWorld, RefusesARestThatNoTensionsHold) {
  scenes::BodyScene body;
  body.name = "cube";
  body.shape = scenes::Shape::box;
  body.rest = scenes::Rest::equilibrium;
  const std::string message = refusal(body);
  EXPECT_NE(message.find("'cube'"), std::string::npos) << message;
}

TEST(BuildWorld, RefusesAMeshThatIsNone) {
  scenes::BodyScene body;
  body.name = "point";
  body.radius = 0.0;
  EXPECT_NE(refusal(body).find("'point'"), std::string::npos);
}

}  // namespace
}  // namespace pneuma::app
