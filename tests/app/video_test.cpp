#include "app/video.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/command_line.h"
#include "app/run_command.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

TEST(VideoCommand, ReadsTheFramesByAPattern) {
  const auto command = video_command(RunFolder("a 100% new", "ball"), 7, 25, "-x.mp4");
  const auto follows = [&](const std::string& option, const std::string& value) {
    const auto at = std::find(command.begin(), command.end(), option);
    return at != command.end() && at + 1 != command.end() && at[1] == value;
  };
  EXPECT_TRUE(follows("-framerate", "25"));
  EXPECT_TRUE(follows("-start_number", "7"));
  EXPECT_TRUE(follows("-i", "file:a 100%% new/ball_%05d.png"));
  EXPECT_EQ(command.back(), "file:-x.mp4");
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
