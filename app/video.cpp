#include "app/video.h"

namespace pneuma::app {
namespace {

/// ffmpeg counts the frames by a pattern, in which a folder's own % must be doubled.
std::string frame_pattern(const RunFolder& folder) {
  std::string pattern;
  for (const char c : (folder.path() / folder.name()).string()) {
    pattern += c;
    if (c == '%') pattern += c;
  }
  return pattern + "_%05d.png";
}

/// ffmpeg takes names such as "-x" for options and "a:b" for protocols.
std::string as_file(const std::string& name) { return "file:" + name; }

}  // namespace

std::vector<std::string> video_command(const RunFolder& folder, std::int64_t first,
                                       int frames_per_second, const std::string& video) {
  return {"ffmpeg", "-y", "-nostdin", "-loglevel", "error", "-framerate",
          std::to_string(frames_per_second), "-start_number", std::to_string(first), "-i",
          as_file(frame_pattern(folder)),
          // Players want 4:2:0 colours, which want an even size.
          "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", as_file(video)};
}

}  // namespace pneuma::app
