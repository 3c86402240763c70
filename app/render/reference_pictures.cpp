#include "app/render/reference_pictures.h"

#include <fmt/format.h>

#include <filesystem>

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

}  // namespace

ExitCode compare_with_reference(const RunFolder& run, std::int64_t first, std::int64_t last,
                                const ReferencePictures& reference) {
  std::int64_t beyond = 0;
  std::int64_t worst = first;
  double most = -1.0;
  for (std::int64_t frame = first; frame <= last; ++frame) {
    const std::filesystem::path ours = run.frame(frame);
    const auto theirs = std::filesystem::path(reference.folder) / ours.filename();
    const double difference = mean_difference(ours.string(), theirs.string());
    if (difference > most) {
      most = difference;
      worst = frame;
    }
    if (difference <= reference.threshold) continue;
    ++beyond;
    fmt::print("{}: {:.3g} from the reference\n", ours.filename().string(), difference);
  }
  fmt::print("{} of {} frames are further than {:g} from {}; frame {} is furthest: {:.3g} of 255\n",
             beyond, last - first + 1, reference.threshold, reference.folder, worst, most);
  return beyond == 0 ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace pneuma::app
