#include "app/render/contact_sheet.h"

#include <algorithm>
#include <utility>

#include "render/image/contact_sheet.h"
#include "render/image/png.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

constexpr int page_width = 1920;  // pixels

/// About twice as wide as its cell: so many pictures as fit on a page fit into the memory, too.
render::Image read_small(const RunFolder& folder, std::int64_t frame, int columns) {
  render::Image image = render::read_png(folder.frame(frame).string());
  const int width = std::min(image.width, 2 * page_width / columns);
  if (width == image.width) return image;
  return render::downscale(image, width, std::max(1, image.height * width / image.width));
}

}  // namespace

std::vector<std::int64_t> evenly_chosen(std::int64_t first, std::int64_t last, int count) {
  std::vector<std::int64_t> chosen;
  const std::int64_t steps = std::min<std::int64_t>(count - 1, last - first);
  for (std::int64_t i = 0; i < steps; ++i) chosen.push_back(first + (last - first) * i / steps);
  chosen.push_back(last);
  return chosen;
}

void write_contact_sheet(const RunFolder& folder, std::int64_t first, std::int64_t last,
                         GridSize grid) {
  std::vector<render::Image> images;
  for (const std::int64_t frame : evenly_chosen(first, last, grid.columns * grid.rows)) {
    images.push_back(read_small(folder, frame, grid.columns));
  }
  const render::Image page = render::contact_sheet(images, grid.columns, grid.rows, page_width);
  base::write_file_atomically(folder.sheet().string(), render::encode_png(page));
}

}  // namespace pneuma::app
