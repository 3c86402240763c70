// What is made beside the frames of a run: turntables, animated pictures, comparisons.

#include "app/render/animated_png.h"
#include "render/image/compare.h"
#include "sim/base/file.h"
#include "tests/app/render/rendered_run.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

class MorePictures : public RenderTest {};

TEST_F(MorePictures, ATurntableShowsOneMomentFromAllAround) {
  const ProgramResult result = render("--frames 4 --turntable 6 --sheet 3x2");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_TRUE(pictures().empty()) << "none of the run";
  const auto turned = pictures("out/turntable");
  ASSERT_EQ(turned.size(), 7u);  // with the sheet
  EXPECT_NE(turned.at("fall_00000.png"), turned.at("fall_00001.png"));
  EXPECT_EQ(render("--frames 4 --turntable 6").exit_code, 6) << "nothing is replaced unasked";
  ASSERT_EQ(render("--frames 4 --turntable 6 --overwrite").exit_code, 0);
  EXPECT_EQ(render("--turntable 0").exit_code, 2);
  EXPECT_EQ(render("--turntable 3 --resume").exit_code, 2);
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = (value << 8) | static_cast<unsigned char>(bytes.at(at + i));
  }
  return value;
}

/// The kinds of chunks, in their order.
std::string chunk_kinds(const std::string& file) {
  std::string kinds;
  for (std::size_t at = 8; at + 8 <= file.size(); at += number_at(file, at) + 12) {
    kinds += file.substr(at + 4, 4) + " ";
  }
  return kinds;
}

TEST_F(MorePictures, AnAnimatedPictureHoldsAllFrames) {
  const fs::path file = out("fall.apng");
  ASSERT_EQ(render(fmt::format("--frames 3 --video '{}'", file.string())).exit_code, 0);
  const std::string bytes = read_text(file);
  EXPECT_EQ(chunk_kinds(bytes), "IHDR acTL fcTL IDAT fcTL fdAT fcTL fdAT IEND ");
  // To a program that knows nothing of animations it is the first frame.
  const render::Image shown = render::read_png(file.string());
  EXPECT_EQ(shown.pixels, render::read_png((out() / "fall_00000.png").string()).pixels);
  // Any other frame is whole: its data, after the sequence number, are those of its own file.
  const std::string second = read_text(out() / "fall_00001.png");
  const std::size_t data = second.find("IDAT") + 4;
  const std::size_t moved = bytes.find("fdAT") + 8;
  EXPECT_EQ(bytes.substr(moved, 200), second.substr(data, 200));
  EXPECT_EQ(number_at(bytes, moved - 4), 2u) << "after two fcTL and before the third";
}

TEST_F(MorePictures, AnAnimatedPictureOfADamagedFrameIsRefused) {
  ASSERT_EQ(render("--frames 2").exit_code, 0);
  write_text(out() / "fall_00001.png", "half");
  const fs::path file = out("fall.apng");
  EXPECT_THROW(write_animated_png(RunFolder(out(), "fall"), 0, 1, 30, file.string()),
               base::IoError);
  EXPECT_FALSE(fs::exists(file));
  EXPECT_FALSE(fs::exists(file.string() + ".tmp"));
}

TEST_F(MorePictures, AReferenceTellsWhatHasChanged) {
  ASSERT_EQ(render_into("before", "--frames 5").exit_code, 0);
  const std::string reference = fmt::format("--reference '{}'", out("before").string());
  const ProgramResult same = render("--frames 5 " + reference);
  EXPECT_EQ(same.exit_code, 0) << same.output;
  EXPECT_NE(same.output.find("0 of 5 frames"), std::string::npos) << same.output;
  const std::string changed = "--frames 5 --overwrite --set picture.shadows=false " + reference;
  const ProgramResult other = render(changed);
  EXPECT_EQ(other.exit_code, 7) << other.output;
  EXPECT_EQ(render(changed + " --threshold 255").exit_code, 0);
  const std::string run = read_text(out() / "run.json");
  const ProgramResult other_size = render(changed + " --size 32x24");
  EXPECT_EQ(other_size.exit_code, 6) << "another size";
  EXPECT_NE(other_size.output.find("64x48 pixels, and this run 32x24; draw it with --size 64x48"),
            std::string::npos)
      << other_size.output;
  const ProgramResult longer = render("--frames 6 --overwrite " + reference);
  EXPECT_EQ(longer.exit_code, 6);
  EXPECT_NE(longer.output.find("fall_00005.png is missing"), std::string::npos) << longer.output;
  EXPECT_EQ(read_text(out() / "run.json"), run) << "before the run";
  EXPECT_EQ(render("--threshold 1").exit_code, 2) << "of what?";
  EXPECT_EQ(render(changed + " --threshold nan").exit_code, 2);
}

/// A camera that moves is no reason for other pictures after a resume.
TEST_F(MorePictures, AMovingCameraComesOutTheSameAfterAResume) {
  const std::string moves = "--set camera.orbit=40 --set 'camera.follow=\"ball\"'";
  ASSERT_EQ(render_into("whole", moves + " --frames 8").exit_code, 0);
  ASSERT_EQ(render(moves + " --frames 4").exit_code, 0);
  ASSERT_EQ(render(moves + " --frames 8 --resume").exit_code, 0);
  EXPECT_EQ(pictures(), pictures("whole"));
}

/// One that is left to the program moves when a ball goes beyond what it has looked ahead for.
TEST_F(MorePictures, AnAutomaticCameraComesOutTheSameWhateverIsDrawn) {
  write_text(scene(), std::string(falling_ball) + R"(
[[body]]
name = "flying"
radius = 1.0
rho_g = 0.0
position = [6.0, 0.0, 9.0]
velocity = [2.0, 0.0, 9.0]
[simulation]
gravity = [0, 0, -4]
)");
  const std::string longer = "--set duration=4 ";
  ASSERT_EQ(render_into("whole", longer + "--frames 101").exit_code, 0);
  const auto whole = pictures("whole");
  const auto eye = [&](std::size_t frame) { return record("whole")["frames"][frame]["camera"]; };
  ASSERT_NE(eye(0), eye(99)) << "it has not moved";

  ASSERT_EQ(render_into("part", longer + "--frames 90-100").exit_code, 0);
  for (const auto& [name, bytes] : pictures("part")) EXPECT_EQ(bytes, whole.at(name)) << name;

  // More frames than at first, by two threads, and a lost one again.
  ASSERT_EQ(render(longer + "--frames 30").exit_code, 0);
  ASSERT_EQ(render(longer + "--frames 101 --threads 2 --resume").exit_code, 0);
  EXPECT_EQ(pictures(), whole);
  fs::remove(out() / "fall_00095.png");
  ASSERT_EQ(render(longer + "--frames 101 --resume").exit_code, 0);
  EXPECT_EQ(pictures(), whole);
}

}  // namespace
}  // namespace pneuma::app
