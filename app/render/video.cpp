#include "app/render/video.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "app/host/run_command.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

constexpr std::array<std::string_view, 11> usual_endings = {
    ".mp4", ".m4v", ".mov", ".mkv", ".webm", ".avi", ".gif", ".webp", ".ogv", ".mpg", ".wmv"};

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

/// ffmpeg's arguments for whatever comes in.
std::vector<std::string> ffmpeg_command(const std::vector<std::string>& input,
                                        const std::string& video) {
  std::vector<std::string> command = {"ffmpeg", "-y", "-nostdin", "-loglevel", "error"};
  command.insert(command.end(), input.begin(), input.end());
  // Players want 4:2:0 colours, which want an even size.
  command.insert(command.end(),
                 {"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", as_file(video)});
  return command;
}

}  // namespace

std::vector<std::string> video_command(const RunFolder& folder, const Frames& frames,
                                       int frames_per_second, const std::string& video) {
  return ffmpeg_command({"-framerate", std::to_string(frames_per_second), "-start_number",
                         std::to_string(frames.first), "-i", as_file(frame_pattern(folder)),
                         "-frames:v", std::to_string(frames.last - frames.first + 1)},
                        video);
}

void check_video_place(const std::string& video) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& why) {
    throw base::IoError(fmt::format("cannot write the video {}: {}", video, why));
  };
  std::error_code ignored;
  const fs::path folder = fs::absolute(video, ignored).parent_path();
  if (fs::is_directory(video, ignored)) refuse("it is a folder; name a file, such as run.mp4");
  if (!fs::is_directory(folder, ignored)) {
    refuse(fmt::format("there is no folder {}; make it, or name another", folder.string()));
  }
  const bool exists = fs::exists(video, ignored);
  if (access(exists ? video.c_str() : folder.c_str(), W_OK) != 0) {
    refuse(fmt::format("{}; name another file", std::strerror(errno)));
  }
}

void check_video_ending(const std::string& video) {
  const std::string ending = std::filesystem::path(video).extension().string();
  if (std::ranges::find(usual_endings, ending) != usual_endings.end()) return;
  throw base::IoError(fmt::format(
      "cannot make the video {}: {}; name a file that ends in one of {}, or in .apng: an animated "
      "picture, which needs no ffmpeg",
      video, ending.empty() ? "it has no ending" : "no video is known by that ending",
      fmt::join(usual_endings, ", ")));
}

void try_video(const std::string& ffmpeg, int width, int height, const std::string& video) {
  namespace fs = std::filesystem;
  const fs::path path(video);
  // The same ending, because ffmpeg chooses the format by it.
  const fs::path trial = path.parent_path() / fmt::format(".{}.{}.trial{}", path.stem().string(),
                                                          getpid(), path.extension().string());
  const std::string frame = fmt::format("color=size={}x{}", width, height);
  struct Removal {
    const fs::path& file;
    ~Removal() {
      std::error_code ignored;
      fs::remove(file, ignored);
    }
  } const removal{trial};
  try {
    run_command(ffmpeg, ffmpeg_command({"-f", "lavfi", "-i", frame, "-frames:v", "1"}, trial));
  } catch (const base::IoError& error) {
    throw base::IoError(fmt::format("cannot make the video {}: {}", video, error.what()));
  }
}

}  // namespace pneuma::app
