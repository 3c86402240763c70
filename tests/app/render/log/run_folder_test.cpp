#include "app/render/log/run_folder.h"

#include <gtest/gtest.h>

#include <set>

#include "app/render/log/journal.h"
#include "sim/base/file.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

TEST(FileOfRun, IsRecognisedByItsWholeName) {
  for (const char* own :
       {"ball_00000.png", "ball_99999.png", "ball_123456.png", "ball_sheet.png", "ball.journal",
        "ball.state", "ball_00001.png.4711-0.tmp", "ball.state.1-22.tmp"}) {
    EXPECT_TRUE(is_file_of_run(own, "ball")) << own;
  }
  for (const char* other :
       {"ball_0000.png", "ball_00000.jpg", "ball_00000.png.bak", "ball_b_00000.png", "ball.toml",
        "ball", "", "xball_00000.png", "ball_00001.png.tmp", "ball_sheet.png.old", "ball_-0001.png",
        "photo.png"}) {
    EXPECT_FALSE(is_file_of_run(other, "ball")) << other;
  }
}

TEST(RunFolder, NamesItsFiles) {
  const RunFolder folder("out", "ball");
  EXPECT_EQ(folder.frame(42), "out/ball_00042.png");
  EXPECT_EQ(folder.frame(123456), "out/ball_123456.png");
  EXPECT_EQ(folder.record(), "out/run.json");
}

TEST(RunFolder, IsMadeWithItsParents) {
  const TemporaryFolder temporary;
  const RunFolder folder(temporary / "a/b/c", "ball");
  folder.make();
  EXPECT_TRUE(fs::is_directory(folder.path()));
  EXPECT_NO_THROW(folder.make());
  EXPECT_TRUE(folder.runs().empty());
}

TEST(RunFolder, CannotBeMadeUnderAFile) {
  const TemporaryFolder temporary;
  write_text(temporary / "file", "");
  EXPECT_THROW(RunFolder(temporary / "file", "ball").make(), base::IoError);
  EXPECT_THROW(RunFolder(temporary / "file/below", "ball").make(), base::IoError);
}

class RunsInFolder : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text = "") const {
    write_text(temporary_ / name, text);
  }
  void write_header(const std::string& name, const std::string& scene) const {
    const Json run = {{"scene", scene}, {"first_frame", 0}, {"last_frame", 5}};
    write(name, Json({{"run", run}}).dump() + "\n");
  }
  RunFolder folder() const { return {temporary_.path(), "ball"}; }
  using Names = std::vector<std::string>;

  TemporaryFolder temporary_;
};

TEST_F(RunsInFolder, AreFoundByRecordOrJournal) {
  write("photo.png");
  write("ball.toml");
  EXPECT_EQ(folder().runs(), Names{});
  write("ball_00007.png");
  write("ball_sheet.png");
  EXPECT_EQ(folder().runs(), Names{});
  EXPECT_EQ(folder().pictures(), (Names{"ball_00007.png", "ball_sheet.png"}));
  write_header("run.json", "cube");
  write_header("torus.journal", "torus");
  EXPECT_EQ(folder().runs(), (Names{"cube", "torus"}));
}

TEST_F(RunsInFolder, DoNotIncludeOtherProgramsJournals) {
  write("system.journal", "LPKSHHRH");
  EXPECT_EQ(folder().runs(), Names{});
}

TEST_F(RunsInFolder, MustNotReplaceOtherProgramsRunJson) {
  for (const char* text : {"{}", "[1]", "text", "{\"run\": 5}", "{\"run\": {\"scene\": 5}}"}) {
    write("run.json", text);
    EXPECT_THROW(folder().runs(), base::IoError) << text;
  }
}

TEST_F(RunsInFolder, AreRemovedAndNothingElse) {
  const std::set<std::string> others = {
      "photo.png",        "cube_notes.txt",           "ball.toml",
      "sphere_00001.png", "sphere_00001.png.1-1.tmp", "system.journal"};
  for (const std::string& name : others) write(name);
  for (const char* name : {"ball_00000.png", "ball_00001.png", "ball_sheet.png", "ball.state",
                           "ball_00002.png.77-3.tmp", "run.json.77-4.tmp", "cube_00000.png"}) {
    write(name);
  }
  write_header("ball.journal", "ball");
  write_header("run.json", "cube");
  folder().remove_runs();
  EXPECT_EQ(names_in(temporary_.path()), others);
}

TEST_F(RunsInFolder, KeepFramesThatTheirRecordsDoNotName) {
  const std::set<std::string> others = {"ball_00006.png", "ball_99999.png",
                                        "ball_99999999999999999999.png", "ball_overlay_00006.png",
                                        "cube_00009.png"};
  for (const std::string& name : others) write(name);
  for (const char* name : {"ball_00005.png", "ball_overlay_00005.png", "cube_00010.png"}) {
    write(name);
  }
  write_header("ball.journal", "ball");
  const Json later = {{"scene", "cube"}, {"first_frame", 10}, {"last_frame", 19}};
  write("run.json", Json({{"run", later}}).dump());
  folder().remove_runs();
  EXPECT_EQ(names_in(temporary_.path()), others);
}

TEST_F(RunsInFolder, LoseAlsoTheFramesOfALaterEnd) {
  const auto run = [](int last) {
    return Json{{"run", {{"scene", "ball"}, {"first_frame", 0}, {"last_frame", last}}}};
  };
  write("ball.journal",
        run(5).dump() + "\n" + Json({{"change", run(9)}, {"first_frame", 5}}).dump() + "\n");
  write("ball_00009.png");
  folder().remove_runs();
  EXPECT_EQ(names_in(temporary_.path()), std::set<std::string>{});
}

TEST_F(RunsInFolder, LeaveFoldersAlone) {
  write_header("run.json", "ball");
  fs::create_directory(temporary_ / "ball_00000.png");
  write("ball_00000.png/precious", "");
  EXPECT_THROW(folder().remove_runs(), base::IoError);
  EXPECT_TRUE(fs::exists(temporary_ / "ball_00000.png/precious"));
}

TEST_F(RunsInFolder, LoseTheirTemporaryFilesOnly) {
  write("ball_00000.png");
  write("ball_00001.png.1-1.tmp");
  write("cube_00001.png.1-1.tmp");
  folder().remove_temporary_files();
  EXPECT_EQ(names_in(temporary_.path()),
            (std::set<std::string>{"ball_00000.png", "cube_00001.png.1-1.tmp"}));
}

}  // namespace
}  // namespace pneuma::app
