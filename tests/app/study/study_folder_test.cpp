#include "app/study/study_folder.h"

#include <gtest/gtest.h>

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

TEST(StudyFolder, CannotBeAFile) {
  const TemporaryFolder temporary;
  write_text(temporary / "file", "");
  EXPECT_THROW(StudyFolder(temporary / "file"), base::IoError);
}

}  // namespace
}  // namespace pneuma::app
