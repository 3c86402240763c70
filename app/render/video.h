// Frames to a video, by ffmpeg where it is installed.
#pragma once

#include <string>
#include <vector>

#include "app/render/log/run_folder.h"
#include "app/terminal/frame_range.h"

namespace pneuma::app {

/// ffmpeg's arguments, itself among them, for these frames, whatever else is beside them.
std::vector<std::string> video_command(const RunFolder& folder, const Frames& frames,
                                       int frames_per_second, const std::string& video);

/// Throws base::IoError when no file can be written there: no such folder, a folder itself, or no
/// permission.
void check_video_place(const std::string& video);

/// Throws base::IoError for an ending by which ffmpeg, which is not here to be asked, would hardly
/// choose a video's format.
void check_video_ending(const std::string& video);

/// Makes a video of one frame of so many pixels beside where the video will be, with the same
/// options, and removes it: whatever ffmpeg lacks, it lacks before the run. Throws base::IoError
/// with what it said.
void try_video(const std::string& ffmpeg, int width, int height, const std::string& video);

}  // namespace pneuma::app
