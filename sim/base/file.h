// Files as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pneuma::base {

/// A file cannot be read or written. what() names the file, the system's reason and what to do.
class IoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes under a temporary name in the same folder, then renames, so that whoever looks at `path`
/// sees the old file or the whole new one, also when the program is killed half way. Not synced to
/// the disk: a power cut may still lose it. On failure removes the temporary file and throws
/// IoError.
void write_file_atomically(const std::string& path, std::span<const std::uint8_t> bytes);

/// A file that cannot be read.
class ReadError : public IoError {
 public:
  ReadError(const std::string& path, std::string reason);
  /// For messages that name the file themselves: "is a folder; name a file in it".
  const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// A file of more bytes than its reader allows.
class FileTooLarge : public ReadError {
 public:
  /// `and_more`: so many bytes were read, and the file, such as a pipe, does not say its size.
  FileTooLarge(const std::string& path, std::uintmax_t bytes, bool and_more, std::size_t max_bytes);
  std::uintmax_t bytes() const { return bytes_; }
  /// "67108865 bytes", "1048577 bytes and more"; with the bytes of other files that count too.
  std::string size_text(std::uintmax_t others = 0) const;

 private:
  std::uintmax_t bytes_;
  bool and_more_;
};

struct ReadOptions {
  /// Of a file without a size, such as a pipe, one byte more is read.
  std::size_t max_bytes = std::numeric_limits<std::size_t>::max();
  /// For messages: "scene file".
  std::string_view what = "file";
};

/// The whole file. Throws ReadError.
std::vector<std::uint8_t> read_file(const std::string& path, const ReadOptions& options = {});

/// The same as text.
std::string read_text_file(const std::string& path, const ReadOptions& options = {});

}  // namespace pneuma::base
