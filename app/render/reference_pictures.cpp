#include "app/render/reference_pictures.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "app/terminal/table.h"
#include "render/image/compare.h"
#include "render/image/png.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

double mean_difference(const std::string& ours, const std::string& theirs) {
  const render::Image a = render::read_png(ours);
  const render::Image b = render::read_png(theirs);
  if (a.width != b.width || a.height != b.height) {
    throw base::IoError(fmt::format("{} has {}x{} pixels and {} {}x{}; draw both with one --size",
                                    ours, a.width, a.height, theirs, b.width, b.height));
  }
  return render::compare_images(a, b, 0).mean;
}

/// As the beginning of the file says.
struct PngSize {
  std::uint32_t width = 0, height = 0;
};

PngSize size_of(const std::filesystem::path& file) {
  constexpr std::string_view begin("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16);
  std::array<char, begin.size() + 8> head = {};
  std::ifstream(file, std::ios::binary).read(head.data(), head.size());
  if (std::string_view(head.data(), begin.size()) != begin) {
    throw base::IoError(fmt::format("--reference: {} is no PNG picture", file.string()));
  }
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      value = value << 8 | static_cast<unsigned char>(head[at + i]);
    }
    return value;
  };
  return {number(begin.size()), number(begin.size() + 4)};
}

std::filesystem::path reference_of(const std::filesystem::path& ours,
                                   const ReferencePictures& reference) {
  return std::filesystem::path(reference.folder) / ours.filename();
}

}  // namespace

void check_reference(const RunFolder& run, std::int64_t first, std::int64_t last, int width,
                     int height, const ReferencePictures& reference) {
  for (std::int64_t frame = first; frame <= last; ++frame) {
    const std::filesystem::path file = reference_of(run.frame(frame), reference);
    if (!std::filesystem::is_regular_file(file)) {
      throw base::IoError(fmt::format(
          "--reference: {} is missing; draw no more frames than it has, as with --frames",
          file.string()));
    }
    const PngSize size = size_of(file);
    if (static_cast<int>(size.width) == width && static_cast<int>(size.height) == height) continue;
    throw base::IoError(fmt::format(
        "--reference: {} has {}x{} pixels, and this run {}x{}; draw it with --size {}x{}",
        file.string(), size.width, size.height, width, height, size.width, size.height));
  }
}

ExitCode compare_with_reference(const RunFolder& run, std::int64_t first, std::int64_t last,
                                const ReferencePictures& reference) {
  std::int64_t beyond = 0;
  std::int64_t worst = first;
  double most = -1.0;
  for (std::int64_t frame = first; frame <= last; ++frame) {
    const std::filesystem::path ours = run.frame(frame);
    const std::filesystem::path theirs = reference_of(ours, reference);
    const double difference = mean_difference(ours.string(), theirs.string());
    if (difference > most) {
      most = difference;
      worst = frame;
    }
    if (difference <= reference.threshold) continue;
    ++beyond;
    fmt::print("{}: {:.3g} from the reference\n", ours.filename().string(), difference);
  }
  fmt::print("{} of {} {} further than {:g} from {}; frame {} is furthest: {:.3g} of 255\n", beyond,
             counted(last - first + 1, "frame"), beyond == 1 ? "is" : "are", reference.threshold,
             reference.folder, worst, most);
  return beyond == 0 ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace pneuma::app
