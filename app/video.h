// Frames to a video, by ffmpeg where it is installed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/run_folder.h"

namespace pneuma::app {

/// ffmpeg's arguments, itself among them, for frames from `first` on.
std::vector<std::string> video_command(const RunFolder& folder, std::int64_t first,
                                       int frames_per_second, const std::string& video);

}  // namespace pneuma::app
