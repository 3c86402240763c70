#include "app/check/volume_range.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/record/pressed_volume.h"
#include "app/terminal/table.h"

namespace pneuma::app {
namespace {

std::string marked(const Volume& volume) {
  return readable(volume.value) + (volume.crosses_itself ? "*" : "");
}

bool has_mark(const VolumeRange& range) {
  return !range.is_obstacle && (range.start.crosses_itself || range.least.crosses_itself ||
                                range.greatest.crosses_itself || range.end.crosses_itself);
}

std::string pressed_text(const VolumeRange& range) {
  if (!range.keeps_gas || range.least.value >= pressed_fraction * range.start.value) return "";
  return fmt::format(": PRESSED to {:.2g} %, more gas carries more",
                     100.0 * range.least.value / range.start.value);
}

std::string range_text(const VolumeRange& range) {
  return fmt::format("{}: {} to {} m^3, {} at the start, {} at the end{}", range.body,
                     marked(range.least), marked(range.greatest), marked(range.start),
                     marked(range.end), pressed_text(range));
}

}  // namespace

void add_volume(const Volume& now, VolumeRange& range) {
  if (now.value < range.least.value) range.least = now;
  if (now.value > range.greatest.value) range.greatest = now;
}

std::string volume_ranges_text(const std::vector<VolumeRange>& volumes) {
  std::string text;
  for (const VolumeRange& range : volumes) {
    if (!range.is_obstacle) text += named_line(text.empty() ? "volume" : "", range_text(range));
  }
  if (!std::ranges::any_of(volumes, has_mark)) return text;
  return text + named_line("",
                           "* not to be trusted, nor is the pressure there: the body crosses "
                           "itself, and such a surface has no inside");
}

}  // namespace pneuma::app
