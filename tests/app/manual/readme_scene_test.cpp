// The scene of one's own in the README: it does what is said beside it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "app/check/run_statistics.h"
#include "app/world/build_world.h"
#include "app/world/gas_advice.h"
#include "scenes/loader/load_scene.h"
#include "tests/support/paths.h"

namespace pneuma::app {
namespace {

/// What stands between ```toml and ```.
std::string readme_scene() {
  std::ifstream readme(project_folder() / "README.md");
  std::string text;
  bool inside = false;
  for (std::string line; std::getline(readme, line);) {
    if (inside && line == "```") break;
    if (inside) text += line + '\n';
    if (line == "```toml") inside = true;
  }
  return text;
}

TEST(ReadmeScene, RunsWithItsBodiesApartAndAtTheirSize) {
  const scenes::Scene scene = scenes::parse_scene(readme_scene(), "two_balls.toml");
  EXPECT_TRUE(scene.camera.eye.has_value());
  const sim::World world = build_world(scene);
  ASSERT_EQ(world.soft.size(), 3u);
  for (const sim::SoftBody& body : world.soft) {
    EXPECT_GT(sim::Vec3(body.velocities[0]).norm(), 0.0) << body.name;
  }
  for (const GasAdvice& advice : gas_advices(world)) {
    EXPECT_NEAR(advice.settled.value() / advice.volume, 1.0, 0.01) << advice.body;
  }
  const RunStatistics run = run_statistics(scene, 1);
  EXPECT_FALSE(run.divergence);
  EXPECT_EQ(run.crossings.frames, 0);
  EXPECT_GT(run.contacts.of(sim::ContactKind::soft_soft).most, 0);
}

TEST(ReadmeScene, SaysHowLargeTheDefaultGasMakesABall) {
  const std::vector<std::string> defaults = {"body.n=10", "body.rest=shape"};
  const sim::World world =
      build_world(scenes::parse_scene(readme_scene(), "two_balls.toml", defaults));
  const GasAdvice advice = gas_advices(world).at(0);
  const std::string said =
      fmt::format("blows this ball up to {:.0f} times its volume", *advice.settled / advice.volume);
  EXPECT_NE(readme_scene().find(said), std::string::npos) << said;
}

}  // namespace
}  // namespace pneuma::app
