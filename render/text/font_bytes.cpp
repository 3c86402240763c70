#include "render/text/font_bytes.h"

// The assembler reads the file: a list of numbers would take the compiler a minute.
__asm__(
    ".section .rodata\n"
    ".hidden pneuma_font_begin\n"
    ".hidden pneuma_font_end\n"
    ".global pneuma_font_begin\n"
    ".global pneuma_font_end\n"
    ".balign 16\n"
    "pneuma_font_begin:\n"
    ".incbin \"" PNEUMA_FONT
    "\"\n"
    "pneuma_font_end:\n"
    ".byte 0\n"
    ".previous\n");

extern "C" {
extern const std::uint8_t pneuma_font_begin[];
extern const std::uint8_t pneuma_font_end[];
}

namespace pneuma::render {

std::span<const std::uint8_t> font_bytes() { return {pneuma_font_begin, pneuma_font_end}; }

}  // namespace pneuma::render
