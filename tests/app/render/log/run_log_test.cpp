#include "app/render/log/run_log.h"

#include <gtest/gtest.h>

#include "app/record/gas_json.h"
#include "app/world/build_world.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

/// Runs of five frames of a ball, with pictures that are only as long as pictures.
class RunLogOfABall : public testing::Test {
 protected:
  RunLog open(ExistingRun existing) const {
    return RunLog(folder_, existing, {scene_, start_, {0, 4}, {}, OnDivergence::stop, "test"});
  }

  /// Draws so many frames of the run.
  void draw(RunLog& log, int count) const {
    Simulation simulation(scene_, log.world(), 1);
    log.append_launch({"pneuma"}, "", 1);
    for (int frame = 0; frame < count; ++frame) {
      while (simulation.frame() < log.next_frame() + frame) simulation.advance_frame();
      write_text(folder_.frame(simulation.frame()), "12345");
      const auto seen = static_cast<float>(simulation.frame()) / 3.0f;
      log.append_frame(frame_state(simulation, {{}, {{seen, 2, 3, 4, 5, 6}}}),
                       {.frame = 5, .overlay = {}}, {}, sim::save_state(simulation.world()));
    }
  }

  TemporaryFolder temporary_;
  RunFolder folder_{temporary_.path(), "test"};
  scenes::Scene scene_ = scenes::parse_scene(
      "duration = 1.0\n[[body]]\nkind = \"soft\"\nshape = \"sphere\"\n", "test.toml");
  sim::World start_ = build_world(scene_);
};

TEST(GasOfBodies, IsZeroOfABodyThatLetItsGasGo) {
  const auto gas_with = [](const std::string& keys) {
    return gas_of_bodies_json<nlohmann::json>(
        build_world(scenes::parse_scene("[[body]]\nname = \"ball\"\n" + keys, "test.toml")));
  };
  EXPECT_EQ(gas_with("supply.n = [[0, 0], [1, 0.5]]\n"),
            nlohmann::json::parse(R"({"ball": {"n": 0.0, "gauge_pressure": 0.0}})"));
  EXPECT_TRUE(gas_with("n = 0\n").empty()) << "none ever";
}

TEST_F(RunLogOfABall, StartsWithTheWorldThatItIsGiven) {
  const RunLog log = open(ExistingRun::refuse);
  EXPECT_FALSE(log.finished());
  EXPECT_EQ(log.next_frame(), 0);
  EXPECT_FALSE(log.seen());
  EXPECT_EQ(sim::state_hash(log.world()), sim::state_hash(start_));
}

TEST_F(RunLogOfABall, GoesOnAfterTheLastFrameWithWhatWasSeenUpToIt) {
  {
    RunLog log = open(ExistingRun::refuse);
    draw(log, 2);
  }
  RunLog log = open(ExistingRun::resume);
  EXPECT_EQ(log.next_frame(), 2);
  EXPECT_EQ(log.seen(), (render::ViewFit::Seen{1.0f / 3.0f, 2, 3, 4, 5, 6}));
  EXPECT_EQ(log.world().steps, scenes::steps_per_frame(scene_));
}

TEST_F(RunLogOfABall, BecomesARecordWhenItIsClosed) {
  {
    RunLog log = open(ExistingRun::refuse);
    draw(log, 2);
  }
  {
    RunLog log = open(ExistingRun::resume);
    draw(log, 3);
    log.close();
  }
  const Json record = Json::parse(read_text(folder_.record()));
  EXPECT_EQ(record["launches"].size(), 2U);
  EXPECT_EQ(record["launches"][1]["first_frame"], 2);
  ASSERT_EQ(record["frames"].size(), 5U);
  EXPECT_EQ(record["frames"][4]["frame"], 4);
  EXPECT_FALSE(fs::exists(folder_.journal()));
  EXPECT_FALSE(fs::exists(folder_.state()));
  EXPECT_TRUE(open(ExistingRun::resume).finished());
}

TEST_F(RunLogOfABall, SaysWhyARunThatDivergedGoesOnWithOtherSteps) {
  {
    RunLog log = open(ExistingRun::refuse);
    draw(log, 2);
    log.append_divergence("the gas exploded");
  }
  scene_.settings.steps_per_second *= 2;
  const RunLog log = open(ExistingRun::resume);
  EXPECT_EQ(log.next_frame(), 2);
  const Json change = read_journal(folder_.journal())->lines.back();
  EXPECT_EQ(change["reason"], "the gas exploded");
  EXPECT_EQ(change["change"]["steps_per_second"], scene_.settings.steps_per_second);
}

}  // namespace
}  // namespace pneuma::app
