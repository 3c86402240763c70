// The font file that the build found, within the program: pictures look alike where none is
// installed.
#pragma once

#include <cstdint>
#include <span>

namespace pneuma::render {

/// DejaVu Sans, as a TrueType file.
std::span<const std::uint8_t> font_bytes();

}  // namespace pneuma::render
