// Program and libraries as `cmake --install` leaves them under a new prefix.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "render/image/png.h"
#include "tests/project/include_graph.h"
#include "tests/support/paths.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace pneuma {
namespace {

namespace fs = std::filesystem;

/// The program would find what is missing in the sources, too.
void expect_data_below(const fs::path& prefix) {
  for (const char* file : {"assets/pear.ply", "assets/cat_2000.ply", "scenes/one_sphere.toml"}) {
    EXPECT_TRUE(fs::is_regular_file(prefix / "share/pneuma" / file)) << prefix << ": " << file;
  }
}

/// One installation for all tests of a process, which leave it as it is.
class Installed : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    installation_ = std::make_unique<TemporaryFolder>();
    const ProgramResult result =
        run_command("cmake --install '" + build_folder().string() + "' --prefix '" +
                    prefix().string() + "' 2>&1 >/dev/null");
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  static void TearDownTestSuite() { installation_.reset(); }

  static fs::path prefix() { return *installation_ / "prefix"; }

  /// From an empty folder, without anything that belongs to a user or to the system.
  ProgramResult run(const fs::path& where, const std::string& arguments) const {
    fs::create_directories(elsewhere_);
    return run_command("cd '" + elsewhere_.string() +
                       "' && XDG_DATA_HOME=/nowhere XDG_DATA_DIRS=/nowhere '" +
                       (where / "bin/pneuma").string() + "' " + arguments + " 2>&1");
  }

  void expect_scenes_below(const fs::path& where) const {
    const ProgramResult result = run(where, "list --json");
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const auto scenes = nlohmann::json::parse(result.output);
    EXPECT_GE(scenes.size(), 13u);
    for (const auto& scene : scenes) {
      EXPECT_TRUE(scene["path"].get<std::string>().starts_with(where.string())) << scene;
    }
  }

  TemporaryFolder folder_;
  fs::path elsewhere_ = folder_ / "elsewhere";

 private:
  static std::unique_ptr<TemporaryFolder> installation_;
};
std::unique_ptr<TemporaryFolder> Installed::installation_;

using LongInstalled = Installed;

TEST_F(Installed, FindsItsScenesAndModelsAlsoWhenMoved) {
  expect_data_below(prefix());
  expect_scenes_below(prefix());
  const fs::path moved = folder_ / "moved to/here";
  fs::create_directories(moved.parent_path());
  fs::copy(prefix(), moved, fs::copy_options::recursive);
  expect_scenes_below(moved);
  const ProgramResult rendered = run(moved, "render one_sphere --frames 1 --size 64x48");
  EXPECT_EQ(rendered.exit_code, 0) << rendered.output;
  EXPECT_TRUE(fs::exists(elsewhere_ / "out/one_sphere/one_sphere_00000.png"));
  const ProgramResult model = run(moved, "check pear.ply");
  EXPECT_EQ(model.exit_code, 0) << model.output;
}

TEST_F(LongInstalled, IsFoundByAProjectOutsideWhichDrawsAPicture) {
  fs::create_directories(elsewhere_);
  const std::string build = (folder_ / "build").string();
  const std::string example = project_folder() / "tests/outside/example";
  const ProgramResult built =
      run_command("exec 2>&1; cmake -S '" + example + "' -B '" + build +
                  "' -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_COMPILER='" PNEUMA_CXX_COMPILER
                  "' -DCMAKE_PREFIX_PATH='" +
                  prefix().string() + "' && cmake --build '" + build + "'");
  ASSERT_EQ(built.exit_code, 0) << built.output;
  const ProgramResult ran =
      run_command("cd '" + elsewhere_.string() + "' && '" + build + "/example' 2>&1");
  ASSERT_EQ(ran.exit_code, 0) << ran.output;

  const render::Image picture = render::read_png((elsewhere_ / "ball.png").string());
  ASSERT_EQ(picture.width, 320);
  std::size_t red = 0;  // pixels of the ball
  for (std::size_t p = 0; p < picture.pixels.size(); p += 3) {
    red += picture.pixels[p] > 2 * picture.pixels[p + 2] ? 1 : 0;
  }
  EXPECT_GT(red, 500u);
}

// A header that includes another one of ours that stays behind cannot be used.
TEST_F(Installed, HasAllHeadersThatItsHeadersInclude) {
  const fs::path headers = prefix() / "include/pneuma";
  const auto includes = includes_of_tree(headers, {"sim", "render"});
  EXPECT_GT(includes.size(), 20u);
  for (const Include& include : includes) {
    EXPECT_TRUE(!include.ours || fs::exists(headers / include.included))
        << include.file << " includes " << include.included;
  }
}

TEST(LongDebianPackage, DependsOnWhatTheProgramLinksAndRunsWhereItIsUnpacked) {
  const TemporaryFolder folder;
  const std::string here = "exec 2>&1; cd '" + folder.path().string() + "' && ";
  const ProgramResult made = run_command(here + "cpack --config '" + build_folder().string() +
                                         "/CPackConfig.cmake' -B . && mv *.deb it.deb");
  ASSERT_EQ(made.exit_code, 0) << made.output;
  const std::string depends = run_command(here + "dpkg-deb --field it.deb Depends").output;
  for (const char* package : {"libc6", "libstdc++6", "libassimp5", "libsundials-cvode"}) {
    EXPECT_NE(depends.find(package), std::string::npos) << depends;
  }
  const ProgramResult ran = run_command(
      here + "dpkg-deb -x it.deb root && XDG_DATA_DIRS=/nowhere root/usr/bin/pneuma check model");
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
  expect_data_below(folder / "root/usr");
  for (const char* file : {"man/man1/pneuma.1", "bash-completion/completions/pneuma",
                           "zsh/vendor-completions/_pneuma", "doc/pneuma/copyright"}) {
    EXPECT_GT(fs::file_size(folder / "root/usr/share" / file), 500u) << file;
  }
}

}  // namespace
}  // namespace pneuma
