#include "app/render/log/journal.h"

#include <gtest/gtest.h>

#include "sim/base/file.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

class JournalTest : public testing::Test {
 protected:
  std::filesystem::path path() const { return folder_ / "test.journal"; }

  /// A header and three lines.
  void write() const {
    Journal journal(path(), 0);
    journal.append({{"run", "header"}});
    for (int i = 0; i < 3; ++i) journal.append({{"frame", i}, {"value", 0.1 * i}});
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(JournalTest, SaysWhatWasWritten) {
  write();
  const auto contents = read_journal(path());
  ASSERT_TRUE(contents);
  EXPECT_EQ(contents->header, Json({{"run", "header"}}));
  ASSERT_EQ(contents->lines.size(), 3u);
  EXPECT_EQ(contents->lines[2]["value"].get<double>(), 0.1 * 2);  // to the last bit
  EXPECT_EQ(contents->ends[2], std::filesystem::file_size(path()));
}

TEST_F(JournalTest, LosesOnlyTheLastLineWhereverItIsCut) {
  write();
  const std::string whole = read_text(path());
  const auto ends = read_journal(path())->ends;
  for (std::size_t cut = ends[1]; cut < whole.size(); ++cut) {
    write_text(path(), whole.substr(0, cut));
    const auto contents = read_journal(path());
    ASSERT_TRUE(contents);
    EXPECT_EQ(contents->lines.size(), 2u) << cut;
  }
}

TEST_F(JournalTest, IsNoneWithoutAWholeHeader) {
  EXPECT_FALSE(read_journal(path()));
  for (const char* text : {"", "{\"run\": 1}", "garbage\n", "[1, 2]\n", "\n"}) {
    write_text(path(), text);
    EXPECT_FALSE(read_journal(path())) << text;
  }
}

TEST_F(JournalTest, EndsAtTheFirstLineThatIsDamaged) {
  write();
  std::string text = read_text(path());
  text[read_journal(path())->ends[0]] = '\0';
  write_text(path(), text);
  EXPECT_EQ(read_journal(path())->lines.size(), 1u);
}

TEST_F(JournalTest, ContinuesWhereItIsTold) {
  write();
  {
    Journal journal(path(), read_journal(path())->ends[0]);
    journal.append({{"frame", "new"}});
  }
  const auto contents = read_journal(path());
  ASSERT_EQ(contents->lines.size(), 2u);
  EXPECT_EQ(contents->lines[0]["frame"], 0);
  EXPECT_EQ(contents->lines[1]["frame"], "new");
}

TEST_F(JournalTest, BelongsToOneRunAtATime) {
  EXPECT_FALSE(is_in_use(path()));
  {
    const Journal journal(path(), 0);
    EXPECT_TRUE(is_in_use(path()));
    EXPECT_THROW(Journal(path(), 0), base::IoError);
  }
  EXPECT_FALSE(is_in_use(path()));
  EXPECT_NO_THROW(Journal(path(), 0));
}

TEST_F(JournalTest, SaysWhyItCannotBeWritten) {
  try {
    const Journal journal("/proc/no_such_folder/a.journal", 0);
    FAIL();
  } catch (const base::IoError& error) {
    EXPECT_NE(std::string(error.what()).find("/proc/no_such_folder/a.journal"), std::string::npos);
  }
}

}  // namespace
}  // namespace pneuma::app
