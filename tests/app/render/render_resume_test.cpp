// `pneuma render` interrupted and continued.
#include <fmt/format.h>

#include <chrono>
#include <random>

#include "tests/app/render/rendered_run.h"

namespace pneuma {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Clock = std::chrono::steady_clock;

// Long enough that most moments lie within it and not within the start of the program. The ball
// slides beyond what the camera has looked ahead for at the start.
const std::string longer =
    "--set 'ball.velocity=[2,0,0]' --set ball.rho_g=0 --set ball.friction=0 --set duration=3";

/// Kills the program after some seconds.
std::string killed_after(double seconds) {
  return fmt::format("timeout --preserve-status -s KILL {:.4f}", seconds);
}

/// Sends the program a signal so many seconds after a file is there.
std::string signalled_at(const fs::path& file, const std::string& signal, double later = 0.0) {
  return fmt::format(
      "PNEUMA_TEST_FILE='{}' bash -c '\"$@\" & while kill -0 $! && "
      "! test -e \"$PNEUMA_TEST_FILE\"; do sleep 0.005; done; "
      "sleep {:.4f}; kill -{} $!; wait $!; exit $?' --",
      file.string(), later, signal);
}

std::vector<std::string> state_hashes(const json& record) {
  std::vector<std::string> hashes;
  for (const json& frame : record["frames"]) hashes.push_back(frame["state_hash"]);
  return hashes;
}

class ResumeTest : public RenderTest {
 protected:
  ResumeTest() {
    const Clock::time_point start = Clock::now();
    const ProgramResult result = render_into("reference", longer);
    seconds_ = std::chrono::duration<double>(Clock::now() - start).count();
    EXPECT_EQ(result.exit_code, 0) << result.output;
    reference_ = pictures("reference");
    const json frames = record("reference")["frames"];
    EXPECT_NE(frames.front()["camera"], frames.back()["camera"]) << "the camera has not moved";
  }

  void expect_like_the_reference() const {
    EXPECT_EQ(pictures().size(), 91u);
    EXPECT_TRUE(pictures() == reference_);  // the bytes are of no use in a message
    EXPECT_EQ(state_hashes(record()), state_hashes(record("reference")));
    for (const auto& entry : fs::directory_iterator(out())) {
      const fs::path file = entry.path().filename();
      EXPECT_TRUE(file.extension() == ".png" || file == "run.json") << file;
    }
  }

  /// Kills come at random moments after random pictures, and again when one came too late. Times
  /// from the start would not do: how long a run takes depends on what else the machine does.
  void kill_and_resume(int times) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> picture(0, 85);
    std::uniform_real_distribution<double> moment(0.0, 0.02);
    int kills = 0, in_the_middle = 0;
    for (int attempt = 0; kills < times && attempt < 5 * times; ++attempt) {
      fs::remove_all(out());
      const fs::path file = out() / fmt::format("fall_{:05}.png", picture(random));
      if (render(longer, signalled_at(file, "KILL", moment(random))).exit_code == 0) continue;
      ++kills;
      const auto left = pictures();
      in_the_middle += !left.empty() && left.size() < reference_.size() ? 1 : 0;
      for (const auto& [name, bytes] : left) {
        ASSERT_TRUE(bytes == reference_[name]) << name << " after kill " << kills;
      }
      const ProgramResult resumed = render(longer + " --resume");
      ASSERT_EQ(resumed.exit_code, 0) << resumed.output;
      expect_like_the_reference();
    }
    EXPECT_EQ(kills, times);
    EXPECT_GT(in_the_middle, 0);
  }

  double seconds_ = 0.0;  // of the uninterrupted run
  std::map<std::string, std::string> reference_;
};

TEST_F(ResumeTest, AKilledRunLeavesWholePicturesAndEndsLikeAnother) { kill_and_resume(5); }

using LongResumeTest = ResumeTest;
TEST_F(LongResumeTest, ARunKilledManyTimesEndsLikeAnother) { kill_and_resume(20); }

TEST_F(ResumeTest, SaysThatThereIsNothingToContinue) {
  const std::string said = out().string() + " holds no run to continue";
  const ProgramResult begun = render("--frames 2 --resume");
  EXPECT_EQ(begun.exit_code, 0);
  EXPECT_NE(begun.output.find(said), std::string::npos) << begun.output;
  for (const char* more : {"--frames 3 --resume", "--frames 3 --resume"}) {
    const ProgramResult result = render(more);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.output.find(said), std::string::npos) << result.output;
  }
}

TEST_F(ResumeTest, ColoursKeepTheScaleOfTheRunSoFar) {
  ASSERT_EQ(render_into("whole", "--show velocity").exit_code, 0);
  // The ball is fastest before it lands, at frame 6.
  ASSERT_EQ(render("--show velocity", signalled_at(out() / "fall_00010.png", "INT")).exit_code,
            130);
  ASSERT_EQ(render("--show velocity --resume").exit_code, 0);
  EXPECT_TRUE(pictures() == pictures("whole"));
  ASSERT_EQ(render_into("part", "--show velocity --frames 12-14").exit_code, 0);
  for (const auto& [name, bytes] : pictures("part")) {
    EXPECT_TRUE(bytes == pictures("whole")[name]) << name;
  }
}

TEST_F(ResumeTest, AnInterruptedRunSaysHowToGoOn) {
  const ProgramResult result = render(longer, signalled_at(out() / "fall_00010.png", "INT"));
  ASSERT_EQ(result.exit_code, 130) << result.output;
  EXPECT_NE(result.output.find("--set duration=3 --resume"), std::string::npos) << result.output;
  expect_whole(pictures());
  EXPECT_EQ(render(longer + " --resume").exit_code, 0);
  expect_like_the_reference();
}

TEST_F(ResumeTest, ATerminatedRunEndsAsAnInterruptedOne) {
  const ProgramResult result = render(longer, signalled_at(out() / "fall_00010.png", "TERM"));
  EXPECT_EQ(result.exit_code, 130) << result.output;
}

TEST_F(ResumeTest, ARunCanBeContinuedAgainAndAgain) {
  int launches = 0;
  for (; launches < 100; ++launches) {
    // Each time a little longer, so that on any machine some launch makes progress.
    const double allowed = seconds_ * (0.1 + 0.05 * launches);
    if (render(longer + " --resume", killed_after(allowed)).exit_code == 0) break;
  }
  EXPECT_GT(launches, 0);
  expect_like_the_reference();
}

TEST_F(ResumeTest, AFinishedRunStaysAsItIs) {
  fs::rename(out("reference"), out());
  const std::string before = read_text(out() / "run.json");
  const ProgramResult result = render(longer + " --resume --sheet 2x2");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("finished"), std::string::npos) << result.output;
  EXPECT_EQ(read_text(out() / "run.json"), before);
  EXPECT_TRUE(fs::exists(out() / "fall_sheet.png"));
}

TEST_F(ResumeTest, LostPicturesOfAFinishedRunAreDrawnAgain) {
  ASSERT_EQ(render("--overlay wireframe").exit_code, 0);
  const auto before = pictures();
  const std::string record_before = read_text(out() / "run.json");
  fs::remove(out() / "fall_00003.png");
  fs::remove(out() / "fall_overlay_00007.png");
  write_text(out() / "fall_00012.png", "half");
  const ProgramResult result = render("--overlay wireframe --resume");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("3 lost pictures"), std::string::npos) << result.output;
  EXPECT_EQ(pictures(), before);
  EXPECT_EQ(read_text(out() / "run.json"), record_before);
}

/// Interrupted or finished: what comes out is what comes out in one go.
TEST_F(ResumeTest, AFirstPartCanBeContinuedToALaterEnd) {
  ASSERT_EQ(render(longer + " --frames 10").exit_code, 0);
  EXPECT_EQ(pictures().size(), 10u);
  ASSERT_EQ(render(longer + " --frames 30 --resume").exit_code, 0);
  EXPECT_EQ(record()["run"]["last_frame"], 29);
  const ProgramResult result =
      render(longer + " --resume", signalled_at(out() / "fall_00050.png", "INT"));
  EXPECT_TRUE(result.exit_code == 130 || result.exit_code == 0) << result.output;
  ASSERT_EQ(render(longer + " --resume").exit_code, 0);
  expect_like_the_reference();
  EXPECT_EQ(record()["run"]["last_frame"], 90);
}

TEST_F(ResumeTest, ARunWithOtherSettingsIsNotContinued) {
  fs::rename(out("reference"), out());
  const struct {
    const char* options;
    const char* difference;
  } others[] = {{" --set body.k=51", "k = 51"},
                {" --frames 5", "last_frame"},
                {" --size 80x60", "width = 80"},
                {" --no-caption", "caption = false"},
                {" --show wireframe", "wireframe"}};
  for (const auto& [options, difference] : others) {
    const ProgramResult result = render(longer + " --resume" + options);
    EXPECT_EQ(result.exit_code, 6);
    EXPECT_NE(result.output.find(difference), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("--overwrite"), std::string::npos) << result.output;
  }
  EXPECT_TRUE(pictures() == reference_);
}

}  // namespace
}  // namespace pneuma
