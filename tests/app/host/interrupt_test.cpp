// SIGINT and SIGTERM before a run has begun, when there is nothing to keep.
#include "app/host/interrupt.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "sim/mesh/primitives.h"
#include "tests/assets/model_writers.h"
#include "tests/support/run_pneuma.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

/// Of the program in a folder, to which the signal is sent after some time. It has some more to
/// end.
ProgramResult stopped_by(const char* signal, const fs::path& folder, const std::string& arguments) {
  return run_command(
      fmt::format("cd '{}' && timeout --preserve-status -k 10 -s {} 0.2 '{}' {} 2>&1",
                  folder.string(), signal, program_file(), arguments));
}

TEST(Interrupt, EndsAWaitForAPipe) {
  const TemporaryFolder folder;
  for (const char* name : {"scene.toml", "model.ply", "sweep.toml"}) {
    const fs::path pipe = folder / name;
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  }
  const std::string out = " --out '" + (folder / "out").string() + "'";
  for (const std::string& arguments : std::vector<std::string>{
           "render scene.toml" + out, "render model.ply" + out, "export model.ply" + out,
           "check scene.toml", "check model.ply", "sweep sweep.toml" + out,
           "study error scene.toml" + out, "study horizons scene.toml" + out}) {
    for (const char* signal : {"INT", "TERM"}) {
      const ProgramResult result = stopped_by(signal, folder.path(), arguments);
      EXPECT_EQ(result.exit_code, 130) << arguments << ": " << result.output;
      EXPECT_EQ(result.output, "pneuma: interrupted\n") << arguments;
    }
  }
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(Interrupt, EndsThePreparationOfALargeModel) {
  const TemporaryFolder folder;
  write_text(folder / "ball.ply", assets::ply_text(sim::make_icosphere(1.0, 6)));
  for (const char* command : {"render", "export", "check"}) {
    const ProgramResult result =
        stopped_by("TERM", folder.path(), fmt::format("{} ball.ply", command));
    EXPECT_EQ(result.exit_code, 130) << command;
    // Once it is prepared, a run says how it goes on, and a check is done.
    EXPECT_TRUE(result.output.ends_with("pneuma: interrupted\n")) << command << result.output;
  }
  EXPECT_FALSE(fs::exists(folder / "out"));
}

}  // namespace
}  // namespace pneuma::app
