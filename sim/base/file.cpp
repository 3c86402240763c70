#include "sim/base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

namespace pneuma::base {
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

std::string bytes_text(std::uintmax_t bytes, bool and_more) {
  return fmt::format("{} bytes{}", bytes, and_more ? " and more" : "");
}

/// Only a regular file's size is known before it is read.
void check_size(const std::string& path, std::size_t max_bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > max_bytes) throw FileTooLarge(path, size, false, max_bytes);
}

/// `Bytes` is a string or a vector of bytes.
template <class Bytes>
Bytes read_bytes(const std::string& path, const ReadOptions& options) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw ReadError(path, fmt::format("is a folder; name a {} in it", options.what));
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw ReadError(path, fmt::format("cannot be opened: {}; check the name and its permissions",
                                      std::strerror(errno)));
  check_size(path, options.max_bytes);
  // In pieces, because a pipe does not say how much it has.
  constexpr std::size_t piece = 1024 * 1024;
  Bytes bytes;
  while (file && bytes.size() <= options.max_bytes) {
    const std::size_t before = bytes.size();
    const std::size_t left = options.max_bytes - before;
    const std::size_t wanted = left < piece ? left + 1 : piece;  // one more than allowed tells
    bytes.resize(before + wanted);
    file.read(reinterpret_cast<char*>(bytes.data()) + before, static_cast<std::streamsize>(wanted));
    bytes.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad())
    throw ReadError(path, fmt::format("cannot be read: {}; check the disk", std::strerror(errno)));
  if (bytes.size() > options.max_bytes) {
    throw FileTooLarge(path, bytes.size(), true, options.max_bytes);
  }
  return bytes;
}

}  // namespace

void write_file_atomically(const std::string& path, std::span<const std::uint8_t> bytes) {
  TemporaryFile file(path);
  file.write_all(bytes);
  file.close_checked();
  file.rename_to_path();
}

ReadError::ReadError(const std::string& path, std::string reason)
    : IoError(fmt::format("{}: {}", path, reason)), reason_(std::move(reason)) {}

FileTooLarge::FileTooLarge(const std::string& path, std::uintmax_t bytes, bool and_more,
                           std::size_t max_bytes)
    : ReadError(path, fmt::format("{} are more than the limit of {}", bytes_text(bytes, and_more),
                                  max_bytes)),
      bytes_(bytes),
      and_more_(and_more) {}

std::string FileTooLarge::size_text(std::uintmax_t others) const {
  return bytes_text(bytes_ + others, and_more_);
}

std::vector<std::uint8_t> read_file(const std::string& path, const ReadOptions& options) {
  return read_bytes<std::vector<std::uint8_t>>(path, options);
}

std::string read_text_file(const std::string& path, const ReadOptions& options) {
  return read_bytes<std::string>(path, options);
}

}  // namespace pneuma::base
