#include "app/render/video.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "app/host/command_line.h"
#include "app/host/find_program.h"
#include "app/host/run_command.h"
#include "sim/base/file.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

TEST(VideoCommand, ReadsTheFramesByAPattern) {
  const auto command = video_command(RunFolder("a 100% new", "ball"), {7, 9}, 25, "-x.mp4");
  const auto follows = [&](const std::string& option, const std::string& value) {
    const auto at = std::find(command.begin(), command.end(), option);
    return at != command.end() && at + 1 != command.end() && at[1] == value;
  };
  EXPECT_TRUE(follows("-framerate", "25"));
  EXPECT_TRUE(follows("-start_number", "7"));
  EXPECT_TRUE(follows("-frames:v", "3"));
  EXPECT_TRUE(follows("-i", "file:a 100%% new/ball_%05d.png"));
  EXPECT_EQ(command.back(), "file:-x.mp4");
}

/// A stand-in for ffmpeg: makes the file that its last argument names, or does not.
std::string stand_in(const TemporaryFolder& folder, const std::string& ending) {
  const std::string program = (folder / "ffmpeg").string();
  write_text(program, "#!/bin/sh\nfor last; do :; done\necho x > \"${last#file:}\"\n" + ending);
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  return program;
}

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(TryVideo, LeavesNothingBehind) {
  const TemporaryFolder folder, videos;
  EXPECT_NO_THROW(try_video(stand_in(folder, "exit 0\n"), 64, 48, (videos / "x.mp4").string()));
  EXPECT_EQ(files_in(videos.path()), 0u);
  try {
    try_video(stand_in(folder, "echo no codec >&2; exit 1\n"), 64, 48, (videos / "x.mp4").string());
    FAIL() << "did not throw";
  } catch (const base::IoError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find((videos / "x.mp4").string()), std::string::npos) << message;
    EXPECT_NE(message.find("ffmpeg failed: no codec"), std::string::npos) << message;
  }
  EXPECT_EQ(files_in(videos.path()), 0u);
}

TEST(TryVideo, TakesAndRefusesWhatTheRealOneDoes) {
  const auto ffmpeg = find_program("ffmpeg");
  if (!ffmpeg) GTEST_SKIP() << "ffmpeg is not installed";
  const TemporaryFolder videos;
  EXPECT_NO_THROW(try_video(*ffmpeg, 63, 47, (videos / "x.mp4").string()));
  EXPECT_THROW(try_video(*ffmpeg, 64, 48, (videos / "x.nonsense").string()), base::IoError);
  EXPECT_EQ(files_in(videos.path()), 0u);
}

TEST(ShellLine, ReadsBackToTheSameArguments) {
  const TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  const std::vector<std::string> arguments = {
      "plain", "with space", "it's", "",  "$HOME `id` \"",   "a\nb",
      "*",     "~",          "\\",   "#", "pad=ceil(iw/2)*2"};
  run_command("/bin/sh", {"sh", "-c", "printf '%s|' " + shell_line(arguments) + " > " + out});
  std::string expected;
  for (const std::string& argument : arguments) expected += argument + "|";
  EXPECT_EQ(read_text(out), expected);
}

}  // namespace
}  // namespace pneuma::app
