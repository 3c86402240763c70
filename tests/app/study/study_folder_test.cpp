#include "app/study/study_folder.h"

#include <gtest/gtest.h>

#include "app/study/study_options.h"
#include "sim/base/file.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

TEST(StudyFolder, IsMadeAndFilled) {
  const TemporaryFolder temporary;
  const StudyFolder folder(temporary / "a/b");
  const auto path = folder.write("table.csv", "one\n");
  EXPECT_EQ(path, temporary / "a/b/table.csv");
  EXPECT_EQ(read_text(path), "one\n");
  folder.write("table.csv", "two\n");
  EXPECT_EQ(read_text(path), "two\n");
}

TEST(StudyFolder, IsNotOpenedOverFilesOfTheStudyUnlessAsked) {
  const TemporaryFolder temporary;
  StudyOptions options;
  options.out = temporary.path().string();
  const StudyFiles files = {{"table.csv"}, {"map"}};
  EXPECT_NO_THROW(open_study_folder(options, files).write("notes.csv", "mine\n"));
  EXPECT_NO_THROW(open_study_folder(options, files)) << "no file of the study's";
  for (const char* name : {"table.csv", "map.gp", "map.svg", "map.png"}) {
    write_text(temporary / name, "mine");
    try {
      open_study_folder(options, files);
      ADD_FAILURE() << name;
    } catch (const base::IoError& error) {
      EXPECT_EQ(error.what(), (temporary / name).string() +
                                  " is there already; replace it with --overwrite, or choose "
                                  "another folder with --out");
    }
    options.overwrite = true;
    EXPECT_NO_THROW(open_study_folder(options, files));
    options.overwrite = false;
    std::filesystem::remove(temporary / name);
  }
}

TEST(StudyFolder, CannotBeAFile) {
  const TemporaryFolder temporary;
  write_text(temporary / "file", "");
  EXPECT_THROW(StudyFolder(temporary / "file"), base::IoError);
}

}  // namespace
}  // namespace pneuma::app
