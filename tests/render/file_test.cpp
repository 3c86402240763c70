#include "render/image/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <thread>

namespace pneuma::render {
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

  std::filesystem::path folder_;
};

TEST_F(AtomicFile, holds_the_bytes_and_leaves_nothing_else) {
  const Bytes bytes = {0, 1, 2, 255, '\n', '\r', 0};
  write_file_atomically(path("a"), bytes);
  EXPECT_EQ(read_file(path("a")), bytes);
  write_file_atomically(path("a"), Bytes{7});
  EXPECT_EQ(read_file(path("a")), Bytes{7});
  write_file_atomically(path("empty"), Bytes{});
  EXPECT_TRUE(read_file(path("empty")).empty());
  EXPECT_EQ(file_count(), 2u);
}

TEST_F(AtomicFile, has_the_permissions_of_any_new_file) {
  const mode_t mask = umask(027);
  write_file_atomically(path("a"), Bytes{1});
  umask(mask);
  struct stat status = {};
  ASSERT_EQ(stat(path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST_F(AtomicFile, names_a_missing_folder) {
  const std::string to = path("missing/a");
  const std::string error = error_of_writing(to, {1});
  EXPECT_NE(error.find(to), std::string::npos) << error;
  EXPECT_NE(error.find("No such file or directory"), std::string::npos) << error;
  EXPECT_NE(error.find("make the folder"), std::string::npos) << error;
}

TEST_F(AtomicFile, will_not_replace_a_folder) {
  std::filesystem::create_directory(folder_ / "taken");
  EXPECT_NE(error_of_writing(path("taken"), {1}), "");
  EXPECT_EQ(file_count(), 1u) << "the temporary file is gone";
}

TEST_F(AtomicFile, a_disk_that_fills_leaves_the_old_file_and_no_other) {
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

TEST_F(AtomicFile, readers_never_see_half_of_it) {
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

TEST_F(AtomicFile, reading_what_is_not_there_says_so) {
  EXPECT_THROW(read_file(path("none")), IoError);
  EXPECT_THROW(read_file(folder_.string()), IoError);
}

}  // namespace
}  // namespace pneuma::render
