#include "app/render/animated_png.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string_view>
#include <vector>

#include "sim/base/file.h"

namespace pneuma::app {
namespace {

using PngBytes = std::vector<std::uint8_t>;
constexpr std::array<std::uint8_t, 8> signature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

/// As PNG has numbers: the high byte first.
void put_number(PngBytes& bytes, std::uint32_t value, int size = 4) {
  for (int i = size - 1; i >= 0; --i) {
    bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
}

std::uint32_t number_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = (value << 8) | bytes[at + i];
  return value;
}

/// What is needed of a picture.
struct PngParts {
  PngBytes header;  // of IHDR: width, height, ...
  PngBytes data;    // of all IDAT
};

PngParts read_parts(const std::string& path) {
  const PngBytes file = base::read_file(path);
  PngParts parts;
  std::size_t at = signature.size();
  while (at + 12 <= file.size()) {
    const std::size_t length = number_at(file, at);
    if (length > file.size() - at - 12) break;
    const std::string_view kind(reinterpret_cast<const char*>(file.data()) + at + 4, 4);
    const auto begin = file.begin() + static_cast<std::ptrdiff_t>(at + 8);
    const auto end = begin + static_cast<std::ptrdiff_t>(length);
    if (kind == "IHDR") parts.header.assign(begin, end);
    if (kind == "IDAT") parts.data.insert(parts.data.end(), begin, end);
    at += length + 12;
  }
  if (parts.header.size() != 13 || parts.data.empty()) {
    throw base::IoError(fmt::format("{} is damaged; draw it again with --resume", path));
  }
  return parts;
}

/// Writes a file of chunks under another name first.
class ChunkFile {
 public:
  explicit ChunkFile(std::string path) : path_(std::move(path)), temporary_(path_ + ".tmp") {
    file_.open(temporary_, std::ios::binary | std::ios::trunc);
    write({signature.data(), signature.size()});
  }
  ~ChunkFile() {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);  // which finish() has renamed
  }
  ChunkFile(const ChunkFile&) = delete;
  ChunkFile& operator=(const ChunkFile&) = delete;

  void chunk(std::string_view kind, const PngBytes& data) {
    PngBytes bytes;
    put_number(bytes, static_cast<std::uint32_t>(data.size()));
    bytes.insert(bytes.end(), kind.begin(), kind.end());
    bytes.insert(bytes.end(), data.begin(), data.end());
    put_number(bytes, libdeflate_crc32(0, bytes.data() + 4, bytes.size() - 4));
    write(bytes);
  }

  void finish() {
    file_.close();
    if (!file_) fail();
    std::filesystem::rename(temporary_, path_);
  }

 private:
  [[noreturn]] void fail() const {
    throw base::IoError(fmt::format("cannot write {}: {}", path_, std::strerror(errno)));
  }
  void write(std::span<const std::uint8_t> bytes) {
    file_.write(reinterpret_cast<const char*>(bytes.data()),
                static_cast<std::streamsize>(bytes.size()));
    if (!file_) fail();
  }

  std::string path_;
  std::string temporary_;
  std::ofstream file_;
};

/// fcTL: the whole picture in place of the one before, for one frame's time.
PngBytes frame_control(std::uint32_t sequence, const PngBytes& header, int frames_per_second) {
  PngBytes control;
  put_number(control, sequence);
  control.insert(control.end(), header.begin(), header.begin() + 8);  // width, height
  put_number(control, 0);                                             // x
  put_number(control, 0);                                             // y
  // As a fraction of two numbers of 16 bits.
  put_number(control, 1, 2);
  put_number(control, static_cast<std::uint32_t>(std::min(frames_per_second, 65535)), 2);
  put_number(control, 0, 2);  // keep the picture; replace all of it
  return control;
}

}  // namespace

bool is_animated_png(const std::string& file) { return file.ends_with(".apng"); }

void write_animated_png(const RunFolder& folder, std::int64_t first, std::int64_t last,
                        int frames_per_second, const std::string& file) {
  ChunkFile chunks(file);
  std::uint32_t sequence = 0;
  for (std::int64_t frame = first; frame <= last; ++frame) {
    const PngParts parts = read_parts(folder.frame(frame).string());
    if (frame == first) {
      chunks.chunk("IHDR", parts.header);
      PngBytes animation;
      put_number(animation, static_cast<std::uint32_t>(last - first + 1));
      put_number(animation, 0);  // for ever
      chunks.chunk("acTL", animation);
    }
    chunks.chunk("fcTL", frame_control(sequence++, parts.header, frames_per_second));
    if (frame == first) {
      chunks.chunk("IDAT", parts.data);
      continue;
    }
    PngBytes data;
    put_number(data, sequence++);
    data.insert(data.end(), parts.data.begin(), parts.data.end());
    chunks.chunk("fdAT", data);
  }
  chunks.chunk("IEND", {});
  chunks.finish();
}

}  // namespace pneuma::app
