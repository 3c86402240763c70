#include "app/sweep/sweep_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <vector>

#include "app/render/contact_sheet.h"
#include "app/sweep/render_run.h"
#include "render/image/contact_sheet.h"
#include "render/image/png.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

constexpr int page_width = 1920;  // pixels
constexpr int most_pictures = 400;
constexpr std::uint8_t grey = 0xbb;

/// The last picture in a folder by its name, which counts frames; empty if there is none.
fs::path last_picture(const fs::path& folder) {
  fs::path last;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".png" && entry.path() > last) last = entry.path();
  }
  return last;
}

/// A square page, or one row for each value of all parameters but the last.
int columns_of(const Sweep& sweep, std::size_t pictures, std::size_t runs) {
  const auto square = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(pictures))));
  if (pictures < runs || sweep.parameters.empty()) return static_cast<int>(square);
  const Parameter& last = sweep.parameters.back();
  const std::size_t values =
      last.is_random() ? static_cast<std::size_t>(sweep.samples) : last.values.size();
  return static_cast<int>(values < 2 || values > 40 ? square : values);
}

/// "body.k = 50, body.n = 0.1": what tells the run from the others.
std::string caption_of(const Sweep& sweep, std::int64_t number) {
  const SweepRun run = run_of(sweep, number);
  std::string text;
  const auto add = [&](const std::string& words) { text += (text.empty() ? "" : ", ") + words; };
  if (sweep.scenes.size() > 1) add(fs::path(run.scene).stem().string());
  for (std::size_t p = 0; p < run.values.size(); ++p) {
    const Parameter& parameter = sweep.parameters[p];
    if (!parameter.is_random() && parameter.values.size() < 2) continue;
    add(fmt::format("{} = {}", parameter.key, run.values[p]));
  }
  return text;
}

}  // namespace

std::optional<std::string> write_sweep_sheet(const StudyFolder& folder, const Sweep& sweep,
                                             const SweepRows& rows) {
  if (sweep.frames == SweepFrames::none || rows.empty()) return std::nullopt;
  std::vector<std::int64_t> numbers;
  for (const auto& [number, row] : rows) numbers.push_back(number);
  std::vector<render::Image> images;
  std::vector<std::string> captions;
  render::Image empty;
  for (const std::int64_t i :
       evenly_chosen(0, static_cast<std::int64_t>(numbers.size()) - 1, most_pictures)) {
    const std::int64_t number = numbers[static_cast<std::size_t>(i)];
    captions.push_back(caption_of(sweep, number));
    const fs::path picture = last_picture(picture_folder(folder.path(), number));
    images.push_back(picture.empty() ? render::Image{} : render::read_png(picture.string()));
    if (!images.back().pixels.empty()) empty = {images.back().width, images.back().height, {}};
  }
  if (empty.width == 0) return std::nullopt;
  empty.pixels.assign(
      static_cast<std::size_t>(empty.width) * static_cast<std::size_t>(empty.height) * 3, grey);
  for (render::Image& image : images) {
    if (image.pixels.empty()) image = empty;
  }
  const int columns = columns_of(sweep, images.size(), rows.size());
  const int count = static_cast<int>(images.size());
  const render::Image page =
      render::contact_sheet(images, columns, (count + columns - 1) / columns, page_width, captions);
  const fs::path path = folder.path() / (sweep.name + "_sheet.png");
  base::write_file_atomically(path.string(), render::encode_png(page));
  return path.string();
}

}  // namespace pneuma::app
