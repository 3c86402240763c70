// PNG files in memory.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace pneuma::render {

/// The bytes of a PNG file. Safe on several threads at once. Throws std::invalid_argument when the
/// image is empty or its pixels do not match its size.
std::vector<std::uint8_t> encode_png(const Image& image);

/// Alpha is dropped, grey becomes three channels. Throws std::invalid_argument for bytes that are
/// not a PNG file.
Image decode_png(std::span<const std::uint8_t> bytes);

/// Throws base::IoError (sim/base/file.h) when the file cannot be read or is not a PNG file.
Image read_png(const std::string& path);

}  // namespace pneuma::render
