// Files as bytes.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace pneuma::render {

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

/// Throws IoError.
std::vector<std::uint8_t> read_file(const std::string& path);

}  // namespace pneuma::render
