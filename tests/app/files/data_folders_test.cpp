#include "app/files/data_folders.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include "app/host/build_info.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

// Each test is a process of its own.
void look_nowhere_else() {
  setenv("XDG_DATA_HOME", "/nowhere", 1);
  setenv("XDG_DATA_DIRS", "/nowhere", 1);
}

fs::path make_folder(const fs::path& folder) {
  fs::create_directories(folder);
  return folder;
}

const fs::path source_scenes = fs::path(PNEUMA_SOURCE_FOLDER) / "scenes";

TEST(DataFolders, LieBesideAnInstalledProgramFirst) {
  look_nowhere_else();
  const TemporaryFolder prefix;
  const fs::path scenes = make_folder(prefix / "share/pneuma/scenes");
  make_folder(prefix / "bin");
  EXPECT_EQ(data_folders("scenes", prefix / "bin/pneuma"),
            (std::vector<fs::path>{scenes, source_scenes}));
  EXPECT_EQ(data_folders("nothing", prefix / "bin/pneuma"), std::vector<fs::path>());
}

TEST(DataFolders, AreThoseOfXdgInItsOrder) {
  const TemporaryFolder home;
  const fs::path own = make_folder(home / ".local/share/pneuma/scenes");
  const fs::path first = make_folder(home / "first/pneuma/scenes");
  const fs::path second = make_folder(home / "second/pneuma/scenes");
  setenv("HOME", home.path().c_str(), 1);
  unsetenv("XDG_DATA_HOME");
  const std::string folders = (home / "first").string() + ":" + (home / "second").string();
  setenv("XDG_DATA_DIRS", folders.c_str(), 1);
  EXPECT_EQ(data_folders("scenes", "/bin/pneuma"),
            (std::vector<fs::path>{own, first, second, source_scenes}));

  setenv("XDG_DATA_HOME", (home / "second").c_str(), 1);  // named twice, found once
  EXPECT_EQ(data_folders("scenes", "/bin/pneuma"),
            (std::vector<fs::path>{second, first, source_scenes}));

  setenv("XDG_DATA_HOME", "scenes/..", 1);  // relative: the specification has it ignored
  unsetenv("XDG_DATA_DIRS");
  EXPECT_EQ(data_folders("scenes", "/bin/pneuma").back(), source_scenes);
}

TEST(DataFolders, OfABuildLieInTheSourceTreeThatMovedWithIt) {
  look_nowhere_else();
  const TemporaryFolder moved;
  const fs::path build = make_folder(moved / "tree/build/kind");
  const fs::path source = (build / PNEUMA_SOURCE_FROM_BUILD).lexically_normal();
  if (!source.string().starts_with(moved.path().string())) {
    GTEST_SKIP() << "this build lies outside its source tree";
  }
  const fs::path scenes = make_folder(source / "scenes");
  EXPECT_EQ(data_folders("scenes", build / "app/pneuma"), std::vector<fs::path>{source_scenes});
  write_text(build / "CMakeCache.txt", "");
  EXPECT_EQ(data_folders("scenes", build / "app/pneuma").front().lexically_normal(), scenes);
}

}  // namespace
}  // namespace pneuma::app
