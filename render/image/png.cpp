// The only file that includes stb_image_write.h and stb_image.h.
#include "render/image/png.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "sim/base/file.h"

// stb_image_write's own deflate takes three times as long and makes larger files.
static unsigned char* pneuma_zlib_compress(const unsigned char* data, int size,
                                           int* compressed_size, int quality);
#define STBIW_ZLIB_COMPRESS pneuma_zlib_compress
#define STBIW_CRC32(buffer, size) libdeflate_crc32(0, buffer, static_cast<size_t>(size))
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

constexpr int deflate_level = 1;  // see the filter below

struct FreeCompressor {
  void operator()(libdeflate_compressor* compressor) const {
    libdeflate_free_compressor(compressor);
  }
};

struct FreeMemory {
  void operator()(unsigned char* memory) const { std::free(memory); }
};

}  // namespace

static unsigned char* pneuma_zlib_compress(const unsigned char* data, int size,
                                           int* compressed_size, int /*quality*/) {
  // A compressor holds close to a megabyte of tables: worth keeping from frame to frame.
  thread_local std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor(
      libdeflate_alloc_compressor(deflate_level));
  if (!compressor) return nullptr;
  const std::size_t bound =
      libdeflate_zlib_compress_bound(compressor.get(), static_cast<std::size_t>(size));
  auto* compressed = static_cast<unsigned char*>(std::malloc(bound));  // stb frees it
  if (compressed == nullptr) return nullptr;
  *compressed_size = static_cast<int>(libdeflate_zlib_compress(
      compressor.get(), data, static_cast<std::size_t>(size), compressed, bound));
  return compressed;
}

namespace pneuma::render {
namespace {

// Each byte minus the one to its left ("sub"), for every row, and deflate's fastest level: 3.5 ms
// for a frame of 640 x 480 and 160 kB. Choosing a filter for each row takes 1.5 ms more and makes
// files 8 % larger; level 6 takes 10 ms and makes files 12 % smaller.
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
