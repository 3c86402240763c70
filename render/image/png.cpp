// The only file that includes stb_image_write.h and stb_image.h.
#include "render/image/png.h"

#include <fmt/format.h>
#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "sim/base/file.h"

// stb_image_write's own deflate takes ten times as long and makes larger files.
static unsigned char* pneuma_zlib_compress(const unsigned char* data, int size,
                                           int* compressed_size, int quality);
#define STBIW_ZLIB_COMPRESS pneuma_zlib_compress
#define STBIW_CRC32(buffer, size) crc32_gzip_refl(0, buffer, static_cast<uint64_t>(size))
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STB_IMAGE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace {

constexpr std::uint32_t deflate_level = 1;  // see the filter below

struct FreeMemory {
  void operator()(unsigned char* memory) const { std::free(memory); }
};

/// Bytes that the compressor may need: what it cannot shorten it stores, in blocks with headers.
std::size_t compressed_bound(std::size_t size) { return size + size / 64 + 1024; }

}  // namespace

static unsigned char* pneuma_zlib_compress(const unsigned char* data, int size,
                                           int* compressed_size, int /*quality*/) {
  // The tables are worth keeping from frame to frame.
  thread_local std::vector<std::uint8_t> tables(ISAL_DEF_LVL1_DEFAULT);
  const std::size_t bound = compressed_bound(static_cast<std::size_t>(size));
  auto* compressed = static_cast<unsigned char*>(std::malloc(bound));  // stb frees it
  if (compressed == nullptr) return nullptr;
  isal_zstream stream;
  isal_deflate_init(&stream);
  stream.end_of_stream = 1;
  stream.gzip_flag = IGZIP_ZLIB;
  stream.level = deflate_level;
  stream.level_buf = tables.data();
  stream.level_buf_size = static_cast<std::uint32_t>(tables.size());
  stream.next_in = const_cast<unsigned char*>(data);  // which it only reads
  stream.avail_in = static_cast<std::uint32_t>(size);
  stream.next_out = compressed;
  stream.avail_out = static_cast<std::uint32_t>(bound);
  if (isal_deflate(&stream) != COMP_OK || stream.internal_state.state != ZSTATE_END) {
    std::free(compressed);
    return nullptr;
  }
  *compressed_size = static_cast<int>(stream.total_out);
  return compressed;
}

namespace pneuma::render {
namespace {

// Each byte minus the one to its left ("sub"), for every row, and one of ISA-L's fast levels.
// Choosing a filter for each row takes longer and makes files larger.
//
// stb keeps the filter in a global: set once, before any thread can be encoding.
[[maybe_unused]] const bool filter_is_set = [] {
  stbi_write_force_png_filter = 1;
  return true;
}();

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image) {
  const auto expected =
      3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width <= 0 || image.height <= 0 || image.pixels.size() != expected) {
    throw std::invalid_argument(fmt::format("encode_png: an image of {} x {} with {} bytes",
                                            image.width, image.height, image.pixels.size()));
  }
  int size = 0;
  const std::unique_ptr<unsigned char, FreeMemory> bytes(stbi_write_png_to_mem(
      image.pixels.data(), 3 * image.width, image.width, image.height, 3, &size));
  if (!bytes) throw std::bad_alloc();
  return {bytes.get(), bytes.get() + size};
}

Image decode_png(std::span<const std::uint8_t> bytes) {
  Image image;
  int channels = 0;
  const std::unique_ptr<unsigned char, FreeMemory> pixels(stbi_load_from_memory(
      bytes.data(), static_cast<int>(bytes.size()), &image.width, &image.height, &channels, 3));
  if (!pixels) {
    throw std::invalid_argument(fmt::format("not a PNG file: {}", stbi_failure_reason()));
  }
  const auto size =
      3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.pixels.assign(pixels.get(), pixels.get() + size);
  return image;
}

Image read_png(const std::string& path) {
  const std::vector<std::uint8_t> bytes = base::read_file(path);
  try {
    return decode_png(bytes);
  } catch (const std::invalid_argument& error) {
    throw base::IoError(fmt::format("{} is damaged: {}; make it again", path, error.what()));
  }
}

}  // namespace pneuma::render
