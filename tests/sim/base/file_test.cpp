#include "sim/base/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <thread>

namespace pneuma::base {
namespace {

using Bytes = std::vector<std::uint8_t>;

class AtomicFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("pneuma-file-test-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_),
                                                  std::filesystem::directory_iterator()));
  }
  /// Writes, and returns what the error says.
  std::string error_of_writing(const std::string& to, const Bytes& bytes) const {
    try {
      write_file_atomically(to, bytes);
    } catch (const IoError& error) {
      return error.what();
    }
    return "";
  }

  static std::string reason_of_reading(const std::string& from, const ReadOptions& options) {
    try {
      read_file(from, options);
    } catch (const ReadError& error) {
      return error.reason();
    }
    return "";
  }

  std::filesystem::path folder_;
};

TEST_F(AtomicFile, HoldsTheBytesAndLeavesNothingElse) {
  const Bytes bytes = {0, 1, 2, 255, '\n', '\r', 0};
  write_file_atomically(path("a"), bytes);
  EXPECT_EQ(read_file(path("a")), bytes);
  write_file_atomically(path("a"), Bytes{7});
  EXPECT_EQ(read_file(path("a")), Bytes{7});
  write_file_atomically(path("empty"), Bytes{});
  EXPECT_TRUE(read_file(path("empty")).empty());
  EXPECT_EQ(file_count(), 2u);
}

TEST_F(AtomicFile, HasThePermissionsOfAnyNewFile) {
  const mode_t mask = umask(027);
  write_file_atomically(path("a"), Bytes{1});
  umask(mask);
  struct stat status = {};
  ASSERT_EQ(stat(path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST_F(AtomicFile, NamesAMissingFolder) {
  const std::string to = path("missing/a");
  const std::string error = error_of_writing(to, {1});
  EXPECT_NE(error.find(to), std::string::npos) << error;
  EXPECT_NE(error.find("No such file or directory"), std::string::npos) << error;
  EXPECT_NE(error.find("make the folder"), std::string::npos) << error;
}

TEST_F(AtomicFile, WillNotReplaceAFolder) {
  std::filesystem::create_directory(folder_ / "taken");
  EXPECT_NE(error_of_writing(path("taken"), {1}), "");
  EXPECT_EQ(file_count(), 1u) << "the temporary file is gone";
}

TEST_F(AtomicFile, ADiskThatFillsLeavesTheOldFileAndNoOther) {
  write_file_atomically(path("a"), Bytes{1, 2, 3});
  // A limit on the size of files fails a write half way, as a full disk does.
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string error = error_of_writing(path("a"), Bytes(5000));
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_NE(error.find("File too large"), std::string::npos) << error;
  EXPECT_NE(error.find("free some space"), std::string::npos) << error;
  EXPECT_EQ(read_file(path("a")), (Bytes{1, 2, 3}));
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFile, ReadersNeverSeeHalfOfIt) {
  const Bytes ones(300000, 1);
  const Bytes twos(200000, 2);
  write_file_atomically(path("a"), ones);
  std::thread writer([&] {
    for (int i = 0; i < 100; ++i) write_file_atomically(path("a"), i % 2 == 0 ? twos : ones);
  });
  for (int i = 0; i < 100; ++i) {
    const Bytes seen = read_file(path("a"));
    EXPECT_TRUE(seen == ones || seen == twos) << seen.size() << " bytes";
  }
  writer.join();
}

TEST_F(AtomicFile, ReadingWhatIsNotThereSaysSo) {
  EXPECT_EQ(reason_of_reading(path("none"), {}),
            "cannot be opened: No such file or directory; check the name and its permissions");
  EXPECT_EQ(reason_of_reading(folder_.string(), {.what = "scene file"}),
            "is a folder; name a scene file in it");
}

TEST_F(AtomicFile, AFileAboveTheLimitIsRefusedWithItsSize) {
  constexpr std::size_t mib = 1024 * 1024;
  for (const std::size_t size : {std::size_t{1}, std::size_t{5}, mib, mib + 1, 2 * mib + 1}) {
    const Bytes bytes(size, 7);
    write_file_atomically(path("a"), bytes);
    EXPECT_EQ(read_file(path("a"), {.max_bytes = size}), bytes);
    EXPECT_EQ(read_text_file(path("a"), {.max_bytes = size}), std::string(size, 7));
    EXPECT_EQ(
        reason_of_reading(path("a"), {.max_bytes = size - 1}),
        std::to_string(size) + " bytes are more than the limit of " + std::to_string(size - 1));
  }
}

TEST_F(AtomicFile, OfAFileWithoutASizeOneByteAboveTheLimitIsRead) {
  EXPECT_EQ(reason_of_reading("/dev/zero", {.max_bytes = 5}),
            "6 bytes and more are more than the limit of 5");
  try {
    read_file("/dev/zero", {.max_bytes = 0});
    FAIL() << "was read";
  } catch (const FileTooLarge& error) {
    EXPECT_EQ(error.bytes(), 1u);
    EXPECT_EQ(error.size_text(9), "10 bytes and more");
    EXPECT_EQ(error.what(), "/dev/zero: " + error.reason());
  }
}

}  // namespace
}  // namespace pneuma::base
