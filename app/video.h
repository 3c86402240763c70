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

/// Runs a command without a shell, its standard output closed. Throws render::IoError with the last
/// line that the command said when it fails, and Interrupted.
void run_command(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace pneuma::app
