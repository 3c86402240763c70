#include "render/image/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace pneuma::render {
namespace {

const char* advice(int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return "make the folder first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder you may write to";
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "free some space or choose another disk";
    case EISDIR:
    case EEXIST:
    case ENOTEMPTY:
      return "choose a name that is not a folder's";
    default:
      return "check the disk or choose another folder";
  }
}

/// The file being written, under its temporary name; removed unless renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path) : path_(path) {
    // Unlike any other of this process (the count) or of another (its number).
    static std::atomic<unsigned> count = 0;
    name_ = fmt::format("{}.{}-{}.tmp", path, getpid(), count++);
    // O_CREAT's 0666 leaves the permissions to the user's umask, as for any other file.
    descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail();
  }

  ~TemporaryFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!renamed_) unlink(name_.c_str());
  }

  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write_all(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail();
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  /// Some file systems (NFS, quotas) report a full disk no sooner than here.
  void close_checked() {
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (close(descriptor) != 0) fail();
  }

  void rename_to_path() {
    if (std::rename(name_.c_str(), path_.c_str()) != 0) fail();
    renamed_ = true;
  }

 private:
  [[noreturn]] void fail() const {
    const int error = errno;
    throw IoError(
        fmt::format("cannot write {}: {}; {}", path_, std::strerror(error), advice(error)));
  }

  std::string path_;
  std::string name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

}  // namespace

void write_file_atomically(const std::string& path, std::span<const std::uint8_t> bytes) {
  TemporaryFile file(path);
  file.write_all(bytes);
  file.close_checked();
  file.rename_to_path();
}

std::vector<std::uint8_t> read_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw IoError(fmt::format("cannot read {}: it is a folder; name a file in it", path));
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw IoError(fmt::format("cannot read {}: {}; check the name and its permissions", path,
                              std::strerror(errno)));
  }
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file),
                                  std::istreambuf_iterator<char>()};
  if (file.bad()) {
    throw IoError(fmt::format("cannot read {}: {}; check the disk", path, std::strerror(errno)));
  }
  return bytes;
}

}  // namespace pneuma::render
