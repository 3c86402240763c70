// Frames as one animated PNG, which browsers play: no ffmpeg is needed.
#pragma once

#include <cstdint>
#include <string>

#include "app/render/log/run_folder.h"

namespace pneuma::app {

/// Whether the file's name ends as an animated PNG's: .apng.
bool is_animated_png(const std::string& file);

/// Puts the frames' own compressed pictures one after the other, as the third edition of the PNG
/// specification (W3C, 2025, section 11.3.6) has it; played again and again. Throws base::IoError,
/// also for a frame that is no PNG file.
void write_animated_png(const RunFolder& folder, std::int64_t first, std::int64_t last,
                        int frames_per_second, const std::string& file);

}  // namespace pneuma::app
