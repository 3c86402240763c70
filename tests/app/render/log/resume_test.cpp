#include "app/render/log/resume.h"

#include <gtest/gtest.h>

#include <optional>

#include "app/render/log/run_record.h"
#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "scenes/loader/load_scene.h"
#include "sim/base/file.h"
#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* ball = R"(
duration = 1.0
[[body]]
kind = "soft"
shape = "sphere"
)";

/// A run of which five frames are done, with pictures that are only as long as pictures.
class UnfinishedRun : public testing::Test {
 protected:
  UnfinishedRun() {
    Journal journal(folder_.journal(), 0);
    journal.append({{"run", identity_}, {"scene_toml", "k = 1\nn = 2\n"}});
    journal.append(launch_line({"pneuma"}, "", 1, 0));
    Simulation simulation(scene_, start_, 1);
    for (int frame = 0; frame < 5; ++frame) {
      if (frame > 0) simulation.advance_frame();
      write_text(folder_.frame(frame), "12345");
      journal.append(frame_line(frame_state(simulation, {}), {.frame = 5, .overlay = {}}, {}));
      states_.push_back(sim::save_state(simulation.world()));
      hashes_.push_back(sim::state_hash(simulation.world()));
    }
    save_state(4);
  }

  void save_state(std::size_t frame) const {
    base::write_file_atomically(folder_.state().string(), states_[frame]);
  }

  Continuation found() const {
    return find_continuation(folder_, *read_journal(folder_.journal()), identity_, start_, 0, 2);
  }

  void expect_continued_after(std::int64_t frame) const {
    const Continuation from = found();
    EXPECT_EQ(from.next_frame, frame + 1);
    EXPECT_EQ(sim::state_hash(from.world), hashes_[sim::at(static_cast<int>(frame))]);
    // The header and the launch, then the frames.
    EXPECT_EQ(from.journal_bytes,
              read_journal(folder_.journal())->ends[sim::at(static_cast<int>(frame)) + 1]);
  }

  void expect_from_the_start() const {
    const Continuation from = found();
    EXPECT_EQ(from.next_frame, 0);
    EXPECT_EQ(sim::state_hash(from.world), sim::state_hash(start_));
    EXPECT_EQ(from.journal_bytes, read_journal(folder_.journal())->header_end);
  }

  OpenedFolder open(ExistingRun existing, const Json& identity) const {
    return open_folder(folder_, existing, identity, "k = 1\nn = 3\n");
  }

  /// Why the run is not continued.
  std::string refusal(const Json& identity) const {
    try {
      open(ExistingRun::resume, identity);
    } catch (const base::IoError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder temporary_;
  RunFolder folder_{temporary_.path(), "test"};
  Json identity_ = {
      {"scene", "test"}, {"fingerprint", "0x1"}, {"first_frame", 0}, {"last_frame", 9}};
  scenes::Scene scene_ = scenes::parse_scene(ball, "test.toml");
  sim::World start_ = build_world(scene_);
  std::vector<std::vector<std::uint8_t>> states_;
  std::vector<std::uint64_t> hashes_;
};

TEST_F(UnfinishedRun, GoesOnAfterItsLastFrame) { expect_continued_after(4); }

TEST_F(UnfinishedRun, GoesBackToItsState) {
  save_state(2);
  expect_continued_after(2);
}

TEST_F(UnfinishedRun, WithoutAStateIsSteppedAgainButNotDrawnAgain) {
  fs::remove(folder_.state());
  const Continuation from = found();
  EXPECT_EQ(from.next_frame, 5);
  EXPECT_EQ(sim::state_hash(from.world), sim::state_hash(start_));
  write_text(folder_.frame(3), "123");
  EXPECT_EQ(found().next_frame, 3);
}

TEST_F(UnfinishedRun, StartsAnewWhenTheStateIsDamaged) {
  std::string state = read_text(folder_.state());
  state[state.size() / 2] = static_cast<char>(state[state.size() / 2] ^ 1);
  write_text(folder_.state(), state);
  expect_from_the_start();
  write_text(folder_.state(), "");
  expect_from_the_start();
}

TEST_F(UnfinishedRun, StartsAnewWhenAPictureIsMissingOrCut) {
  write_text(folder_.frame(3), "123");
  expect_from_the_start();
  write_text(folder_.frame(3), "12345");
  expect_continued_after(4);
  fs::remove(folder_.frame(0));
  expect_from_the_start();
}

TEST_F(UnfinishedRun, StartsAnewWhenTheStateIsOfAnotherRun) {
  sim::World other = start_;
  other.soft[0].velocities[0] = sim::Vec3(1.0, 2.0, 3.0);
  other.steps = 2;
  base::write_file_atomically(folder_.state().string(), sim::save_state(other));
  expect_from_the_start();
}

TEST_F(UnfinishedRun, IsContinuedByOneOfTheSameIdentity) {
  const OpenedFolder opened = open(ExistingRun::resume, identity_);
  EXPECT_FALSE(opened.finished);
  ASSERT_TRUE(opened.unfinished);
  EXPECT_EQ(opened.unfinished->header["run"], identity_);
}

TEST_F(UnfinishedRun, IsNotContinuedByAnother) {
  Json shorter = identity_;
  shorter["last_frame"] = 8;
  EXPECT_NE(refusal(shorter).find("last_frame: was 9, is 8"), std::string::npos);
  Json later = identity_;
  later["first_frame"] = 1;
  EXPECT_NE(refusal(later).find("first_frame: was 0, is 1"), std::string::npos);

  Json other_scene = identity_;
  other_scene["fingerprint"] = "0x2";
  const std::string message = refusal(other_scene);
  EXPECT_NE(message.find("was  n = 2"), std::string::npos) << message;
  EXPECT_NE(message.find("is   n = 3"), std::string::npos) << message;
  EXPECT_EQ(message.find("k = 1"), std::string::npos) << message;
  EXPECT_NE(message.find("--overwrite"), std::string::npos) << message;
}

TEST_F(UnfinishedRun, IsNotReplacedUnasked) {
  EXPECT_THROW(open(ExistingRun::refuse, identity_), base::IoError);
  EXPECT_TRUE(fs::exists(folder_.frame(4)));
  EXPECT_FALSE(open(ExistingRun::overwrite, identity_).unfinished);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(UnfinishedRun, IsLeftAloneWhileItGoesOn) {
  const Journal writing(folder_.journal(), read_journal(folder_.journal())->ends.back());
  for (const auto existing : {ExistingRun::overwrite, ExistingRun::resume}) {
    EXPECT_THROW(open(existing, identity_), base::IoError);
  }
  EXPECT_TRUE(fs::exists(folder_.frame(4)));
}

TEST_F(UnfinishedRun, OfAnotherSceneIsNotContinued) {
  const RunFolder other(temporary_.path(), "other");
  EXPECT_THROW(open_folder(other, ExistingRun::resume, identity_, ""), base::IoError);
}

TEST_F(UnfinishedRun, StartsAnewWhenItsHeaderIsTorn) {
  for (int frame = 0; frame < 5; ++frame) fs::remove(folder_.frame(frame));
  write_text(folder_.journal(), "{\"run\": {");
  const OpenedFolder opened = open(ExistingRun::resume, identity_);
  EXPECT_FALSE(opened.finished);
  EXPECT_FALSE(opened.unfinished);
}

TEST_F(UnfinishedRun, IsNotContinuedWithFramesButNoRecord) {
  fs::remove(folder_.journal());
  EXPECT_NE(refusal(identity_).find("no record"), std::string::npos);
}

TEST_F(UnfinishedRun, IsFinishedOnceItHasARecord) {
  const Json record = whole_record(*read_journal(folder_.journal()));
  write_text(folder_.record(), record.dump());
  fs::remove(folder_.journal());
  EXPECT_TRUE(open(ExistingRun::resume, identity_).finished);
  EXPECT_FALSE(fs::exists(folder_.state()));
  fs::remove(folder_.frame(2));
  const OpenedFolder opened = open(ExistingRun::resume, identity_);
  EXPECT_TRUE(opened.finished);
  ASSERT_EQ(opened.lost.size(), 1u);
  EXPECT_EQ(opened.lost.front()["frame"], 2);
}

TEST_F(UnfinishedRun, GoesOnToALaterEndAndSaysSo) {
  identity_["last_frame"] = 19;
  ASSERT_TRUE(open(ExistingRun::resume, identity_).unfinished);
  expect_continued_after(4);
  EXPECT_NE(found().change, "");
}

TEST_F(UnfinishedRun, OnceFinishedGoesOnToALaterEnd) {
  const Json record = whole_record(*read_journal(folder_.journal()));
  write_text(folder_.record(), record.dump());
  fs::remove(folder_.journal());
  identity_["last_frame"] = 19;
  const OpenedFolder opened = open(ExistingRun::resume, identity_);
  EXPECT_FALSE(opened.finished);
  ASSERT_TRUE(opened.unfinished);
  EXPECT_FALSE(fs::exists(folder_.record()));
  EXPECT_EQ(found().next_frame, 5);
  // Nothing of the record is lost on the way.
  EXPECT_EQ(whole_record(*opened.unfinished), record);
}

TEST_F(UnfinishedRun, OfWhichSettingsChangedHasItsEnd) {
  Journal(folder_.journal(), read_journal(folder_.journal())->ends.back())
      .append(change_line(identity_, scene_, 5, "diverged"));
  write_text(folder_.record(), whole_record(*read_journal(folder_.journal())).dump());
  fs::remove(folder_.journal());
  identity_["last_frame"] = 19;
  EXPECT_NE(refusal(identity_).find("settings changed on the way"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_.record()));
}

}  // namespace
}  // namespace pneuma::app
