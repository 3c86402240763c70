// What a scene holds of its bodies.
#include "app/world/pin_body.h"

#include <gtest/gtest.h>

#include <numbers>

#include "app/check/run_statistics.h"
#include "app/world/build_world.h"
#include "app/world/distinct_bodies.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/soft/pins.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

scenes::Scene scene_of(const std::string& text) { return scenes::parse_scene(text, "held.toml"); }

const std::string two_balls = R"(
duration = 1.0
[[body]]
name = "ball"
radius = 1.0
n = 0.05
rest = "equilibrium"
velocity = [1, 0, 0]
position = [0, 0, 3]
copies = [2, 1, 1]
spacing = [5, 0, 0]
)";

TEST(PinBody, HoldsOfEachCopyWhatStartsInABox) {
  const sim::World world = build_world(scene_of(two_balls + "pinned = [[-9, -9, 3.5, 9, 9, 9]]\n"));
  for (const sim::SoftBody& body : world.soft) {
    int pinned = 0;
    for (int v = 0; v < body.positions.size(); ++v) {
      EXPECT_EQ(sim::is_pinned(body, v), body.positions[v].z() >= 3.5);
      EXPECT_EQ(body.velocities[v].x(), sim::is_pinned(body, v) ? 0.0 : 1.0);
      pinned += sim::is_pinned(body, v) ? 1 : 0;
    }
    EXPECT_GT(pinned, 0);
    EXPECT_LT(pinned, body.positions.size());
    EXPECT_FALSE(body.pins->are_moved);
  }
}

TEST(PinBody, MovesWhatIsPinnedButWhatIsStillAboutEachCopysOwnPosition) {
  const sim::World start =
      build_world(scene_of(two_balls + "pinned = [[-9, -9, 3.5, 9, 9, 9], [-9, -9, 0, 9, 9, 2.5]]\n"
                                       "motion.rotation = [[0, 0, 0, 0], [0.5, 0, 0, 90]]\n"
                                       "motion.still = [[-9, -9, 0, 9, 9, 2.5]]\n"));
  sim::World world = start;
  sim::Stepper stepper(world);
  while (sim::time(world) < 0.75) ASSERT_FALSE(stepper.step(world));
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 centre(5.0 * static_cast<double>(i), 0.0, 3.0);
    for (int v = 0; v < world.soft[i].positions.size(); ++v) {
      if (!sim::is_pinned(world.soft[i], v)) continue;
      const Vec3 before = start.soft[i].positions[v], arm = before - centre;
      const Vec3 turned = centre + Vec3(-arm.y(), arm.x(), arm.z());
      const Vec3 expected = before.z() > 3.0 ? turned : before;
      EXPECT_LT((Vec3(world.soft[i].positions[v]) - expected).norm(), 1e-14);
    }
  }
}

TEST(PinBody, SaysWhereABoxHoldsNothing) {
  const auto refusal = [](const std::string& keys) -> std::string {
    try {
      build_world(scene_of(two_balls + keys));
    } catch (const scenes::SceneError& error) {
      return error.what();
    }
    return "";
  };
  const std::string message = refusal("pinned = [[-9, -9, 3.5, 9, 9, 9], [0, 0, 7, 1, 1, 8]]\n");
  EXPECT_TRUE(
      message.starts_with("held.toml:12:10: body 'ball': pinned: no vertex starts in the "
                          "box [0, 0, 7, 1, 1, 8]; at the start they lie from [-1, -1, 2] m "
                          "to [6, 1, 4] m"))
      << message;
  EXPECT_NE(refusal("pinned = [[-9, -9, 3.5, 9, 9, 9]]\nmotion.path = [[0, 0, 0, 0]]\n"
                    "motion.still = [[0, 0, 7, 1, 1, 8]]\n")
                .find("held.toml:14:16: body 'ball': motion.still: no vertex"),
            std::string::npos);
}

const std::string obstacle = R"(
duration = 1.0
[[body]]
kind = "moved"
shape = "icosphere"
radius = 1.0
position = [0, 0, 3]
)";

TEST(PinBody, MakesObstaclesOfMeshes) {
  sim::World world =
      build_world(scene_of(obstacle + "velocity = [1, 0, 0]\nangular_velocity = [0, 0, 2]\n"));
  ASSERT_EQ(world.soft.size(), 1u);
  EXPECT_TRUE(sim::is_kinematic(world, 0));
  EXPECT_TRUE(distinct_bodies(world).empty());
  const sim::VertexArray start = world.soft[0].positions;
  sim::Stepper stepper(world);
  while (world.steps < 60) ASSERT_FALSE(stepper.step(world));
  for (int v = 0; v < start.size(); ++v) {
    const Vec3 arm = Vec3(start[v]) - Vec3(0.0, 0.0, 3.0);
    const Vec3 expected = Vec3(1.0, 0.0, 3.0) + Eigen::AngleAxisd(2.0, Vec3::UnitZ()) * arm;
    EXPECT_LT((Vec3(world.soft[0].positions[v]) - expected).norm(), 1e-12);
  }
}

TEST(PinBody, ARunThatIsSavedAndGoesOnComesToTheSame) {
  const scenes::Scene scene = scene_of(
      two_balls +
      "pinned = [[-9, -9, 3.5, 9, 9, 9]]\nmotion.path = [[0, 0, 0, 0], [1, 0, 0, -1.5]]\n" +
      "[[body]]\nkind = \"static\"\nshape = \"torus\"\nposition = [0, 0, 1]\n");
  sim::World whole = build_world(scene), first = whole;
  sim::Stepper stepper(whole), before(first);
  while (whole.steps < 60) ASSERT_FALSE(stepper.step(whole));
  while (first.steps < 30) ASSERT_FALSE(before.step(first));
  sim::World second = build_world(scene);
  sim::load_state(sim::save_state(first), second);
  sim::Stepper after(second);
  while (second.steps < 60) ASSERT_FALSE(after.step(second));
  EXPECT_EQ(sim::state_hash(second), sim::state_hash(whole));
}

TEST(PinBody, MomentumIsSaidToChangeByPinsAndObstacles) {
  const std::string free = "[simulation]\ngravity = [0, 0, 0]\n[ground]\npresent = false\n";
  using Names = std::vector<std::string>;
  EXPECT_EQ(run_statistics(
                scene_of(two_balls + "rho_g = 0\npinned = [[-9, -9, 3.5, 9, 9, 9]]\n" + free), 1)
                .pushed_by,
            Names{"pins"});
  EXPECT_EQ(run_statistics(scene_of(obstacle + free), 1).pushed_by, Names{"obstacles"});
}

}  // namespace
}  // namespace pneuma::app
