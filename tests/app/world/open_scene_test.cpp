// A model where a scene is expected: it falls, and rests looking like itself.
#include "app/world/open_scene.h"

#include <gtest/gtest.h>

#include "app/world/build_world.h"
#include "app/world/model_scene.h"
#include "app/world/settled_volume.h"
#include "scenes/loader/load_scene.h"
#include "scenes/loader/print_scene.h"
#include "sim/mesh/primitives.h"
#include "tests/assets/model_writers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/worlds.h"

namespace pneuma::app {
namespace {

double volume_of(const sim::SoftBody& body) {
  return sim::volume(body.mesh->topology, body.positions);
}

class OpenScene : public testing::Test {
 protected:
  scenes::Scene open(const sim::TriangleMesh& mesh,
                     const std::vector<std::string>& overrides = {}) {
    write_text(file(), assets::obj_text(mesh));
    return open_scene(file().string(), overrides);
  }
  std::filesystem::path file() const { return folder_ / "it.obj"; }

 private:
  TemporaryFolder folder_;
};

TEST_F(OpenScene, AModelFallsAndRestsAtThePredictedVolume) {
  for (const sim::TriangleMesh& mesh :
       {sim::make_torus(50.0, 20.0, 10, 12), sim::make_box({0.1, 0.2, 0.3}, 4)}) {
    const scenes::Scene scene = open(mesh);
    sim::World world = build_world(scene);
    const double predicted = settled_volume(world.soft.at(0)).value();
    EXPECT_NEAR(predicted / volume_of(world.soft[0]), 1.0, 0.15);
    EXPECT_NEAR(sim::bounds(world).size().maxCoeff(), 6.0, 1e-4);
    EXPECT_NEAR(sim::bounds(world).low.z(), 1.0, 1e-4);
    const auto divergence = sim::run(world, 3.0);
    ASSERT_FALSE(divergence) << divergence->what;
    EXPECT_NEAR(volume_of(world.soft[0]) / predicted, 1.0, 0.1);
    EXPECT_LT(sim::bounds(world).low.z(), 0.2);  // it may still bounce
  }
}

TEST_F(OpenScene, ItsTextIsAFileToKeep) {
  const scenes::Scene scene = open(assets::cube(), {"body.k=900"});
  EXPECT_EQ(scene.bodies[0].material.k, 900.0);
  EXPECT_EQ(scene.name, "it");
  const scenes::Scene plain = scenes::parse_scene(model_scene_text(file()), "it.toml");
  EXPECT_EQ(plain.bodies[0].material.k, 4000.0);
  const scenes::Scene again = scenes::parse_scene(scenes::print_scene(scene), "it.toml");
  EXPECT_EQ(scenes::scene_fingerprint(again), scenes::scene_fingerprint(scene));
}

}  // namespace
}  // namespace pneuma::app
