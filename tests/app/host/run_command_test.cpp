#include "app/host/run_command.h"

#include <gtest/gtest.h>

#include "sim/base/file.h"
#include "tests/support/temporary_folder.h"

namespace pneuma::app {
namespace {

std::string failure_of(const std::string& script) {
  try {
    run_command("/bin/sh", {"sh", "-c", script});
  } catch (const base::IoError& error) {
    return error.what();
  }
  return "";
}

TEST(RunCommand, IsQuietWhenAllGoesWell) { EXPECT_EQ(failure_of("echo fine >&2; exit 0"), ""); }

TEST(RunCommand, ReportsTheLastLineOfAFailure) {
  EXPECT_EQ(failure_of("echo first >&2; echo last words >&2; exit 3"), "sh failed: last words");
  EXPECT_EQ(failure_of("exit 1"), "sh failed: it said nothing");
}

TEST(RunCommand, ReportsAnEndBySignal) { EXPECT_NE(failure_of("kill -9 $$"), ""); }

TEST(RunCommand, DoesNotWaitForInput) { EXPECT_EQ(failure_of("cat"), ""); }

TEST(RunCommand, ReadsMoreThanAPipeHolds) {
  EXPECT_EQ(
      failure_of("head -c 1000000 /dev/zero | tr '\\0' x >&2; echo >&2; echo end >&2; exit 1"),
      "sh failed: end");
}

TEST(RunCommand, SaysWhenThereIsNoSuchProgram) {
  EXPECT_THROW(run_command("/no/such/program", {"program"}), base::IoError);
}

TEST(RunCommand, RunsInAFolder) {
  const TemporaryFolder folder;
  run_command("/bin/sh", {"sh", "-c", "echo here > file"}, folder.path());
  EXPECT_EQ(read_text(folder / "file"), "here\n");
  EXPECT_THROW(run_command("/bin/sh", {"sh", "-c", "true"}, folder / "missing"), base::IoError);
}

}  // namespace
}  // namespace pneuma::app
