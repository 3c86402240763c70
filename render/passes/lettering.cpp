#include "render/passes/lettering.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pneuma::render {
namespace {

const Ink letter_ink = {0.97f, 0.97f, 0.96f, 1.0f};
const Ink panel_ink = {0.10f, 0.12f, 0.15f, 0.68f};

struct Rectangle {
  Eigen::Vector2f min;
  Eigen::Vector2f max;

  bool meets(const Rectangle& other) const {
    return (min.array() < other.max.array()).all() && (other.min.array() < max.array()).all();
  }
};

int whole(float pixels) { return static_cast<int>(std::lround(pixels)); }

std::string length_text(float metres) {
  if (metres >= 1000.0f) return fmt::format("{:g} km", metres / 1000.0f);
  if (metres >= 1.0f) return fmt::format("{:g} m", metres);
  if (metres >= 0.01f) return fmt::format("{:g} cm", metres * 100.0f);
  return fmt::format("{:g} mm", metres * 1000.0f);
}

/// Pixels from the upper left corner; nothing behind the eye or beside the picture.
std::optional<Eigen::Vector2f> seen_at(const View& view, const Vec3f& point) {
  const Eigen::Vector4f clip = view.view_projection * point.homogeneous();
  if (clip.w() <= 0.0f) return std::nullopt;
  const Eigen::Vector2f at = clip.head<2>() / clip.w();
  if ((at.array().abs() > 1.0f).any()) return std::nullopt;
  return Eigen::Vector2f(0.5f * (1.0f + at.x()) * static_cast<float>(view.width),
                         0.5f * (1.0f - at.y()) * static_cast<float>(view.height));
}

}  // namespace

float round_length(float length) {
  const float power = std::pow(10.0f, std::floor(std::log10(length)));
  for (const float factor : {5.0f, 2.0f}) {
    if (factor * power <= length) return factor * power;
  }
  return power;
}

void Lettering::draw(const View& view, const Frame& frame) {
  em_ = std::max(11.0f, std::round(13.5f * view.pixel_scale));  // below, letters are hard to read
  padding_ = std::round(0.45f * em_);
  margin_ = std::round(0.6f * em_);
  drawing_.begin();
  draw_labels(view, frame.labels);
  if (frame.legend) draw_legend(view, *frame.legend);
  const float right = frame.scale_bar ? draw_scale_bar(view) : static_cast<float>(view.width);
  if (frame.caption && !frame.caption->text.empty()) draw_caption(view, frame.caption->text, right);
  drawing_.draw(view);
}

TextLayout Lettering::laid_out(const std::string& text, float most_width) const {
  return lay_out(drawing_.font(), text, em_, most_width);
}

void Lettering::panel(const TextLayout& layout, float x, float y) {
  const Eigen::Vector2f min = {std::round(x), std::round(y)};
  const Eigen::Vector2f size = {std::ceil(layout.width), std::ceil(layout.height)};
  drawing_.rectangle(min, (min + size).array() + 2.0f * padding_, panel_ink);
  drawing_.text(layout, whole(min.x() + padding_), whole(min.y() + padding_), letter_ink);
}

void Lettering::draw_caption(const View& view, const std::string& text, float right) {
  const TextLayout layout = laid_out(text, right - 2.0f * (margin_ + padding_));
  panel(layout, margin_,
        static_cast<float>(view.height) - margin_ - 2.0f * padding_ - std::ceil(layout.height));
}

float Lettering::draw_scale_bar(const View& view) {
  const float distance = (view.target - view.eye).norm();
  const float pixels = 0.5f * static_cast<float>(view.height) * view.projection(1, 1) / distance;
  const float length = round_length(0.2f * static_cast<float>(view.width) / pixels);
  const TextLayout layout = laid_out(length_text(length), static_cast<float>(view.width));
  const float width = std::max(length * pixels, std::ceil(layout.width));
  const float thick = std::max(2.0f, std::round(0.2f * em_));
  const Eigen::Vector2f max = {static_cast<float>(view.width) - margin_,
                               static_cast<float>(view.height) - margin_};
  const Eigen::Vector2f min =
      max - Eigen::Vector2f(width + 2.0f * padding_,
                            std::ceil(layout.height) + 2.0f * padding_ + 2.0f * thick);
  drawing_.rectangle(min, max, panel_ink);
  drawing_.text(layout, whole(0.5f * (min.x() + max.x() - layout.width)), whole(min.y() + padding_),
                letter_ink);
  const float middle = 0.5f * (min.x() + max.x());
  const float bottom = max.y() - padding_;
  const Eigen::Vector2f from = {middle - 0.5f * length * pixels, bottom - thick};
  const Eigen::Vector2f to = {middle + 0.5f * length * pixels, bottom};
  drawing_.rectangle(from, to, letter_ink);
  for (const float end : {from.x(), to.x() - 0.5f * thick}) {
    drawing_.rectangle({end, from.y() - thick}, {end + 0.5f * thick, to.y()}, letter_ink);
  }
  return min.x();
}

void Lettering::draw_labels(const View& view, const std::vector<Label>& labels) {
  const Eigen::Vector2f picture = {static_cast<float>(view.width), static_cast<float>(view.height)};
  std::vector<Rectangle> taken;
  for (const Label& label : labels) {
    const auto at = seen_at(view, label.position);
    if (!at || label.text.empty()) continue;
    const TextLayout layout = laid_out(label.text, picture.x() - 2.0f * (margin_ + padding_));
    const Eigen::Vector2f size = {std::ceil(layout.width) + 2.0f * padding_,
                                  std::ceil(layout.height) + 2.0f * padding_};
    Eigen::Vector2f min = {at->x() - 0.5f * size.x(), at->y() - size.y() - 0.3f * em_};
    min = min.cwiseMin(picture - size).cwiseMax(0.0f);
    // Above the labels before it that are in its way, for as long as there is room.
    for (bool moved = true; moved;) {
      moved = false;
      for (const Rectangle& other : taken) {
        if (!other.meets({min, min + size}) || other.min.y() < size.y() + 1.0f) continue;
        min.y() = other.min.y() - size.y() - 1.0f;
        moved = true;
      }
    }
    taken.push_back({min, min + size});
    panel(layout, min.x(), min.y());
  }
}

void Lettering::draw_legend(const View& view, const Legend& legend) {
  const float picture_width = static_cast<float>(view.width);
  const float bar_height = std::round(0.4f * static_cast<float>(view.height));
  const float bar_width = std::round(1.1f * em_);
  const TextLayout title = laid_out(legend.title, 0.3f * picture_width);
  std::vector<TextLayout> ticks;
  float widest = 0.0f;
  for (const Legend::Tick& tick : legend.ticks) {
    ticks.push_back(laid_out(tick.text, 0.3f * picture_width));
    widest = std::max(widest, std::ceil(ticks.back().width));
  }
  const float line = drawing_.font().line_height(em_);
  const float width = std::max(std::ceil(title.width), bar_width + padding_ + widest);
  const float height = std::ceil(title.height) + padding_ + bar_height + line;
  const Eigen::Vector2f min = {picture_width - margin_ - 2.0f * padding_ - width, margin_};
  const Eigen::Vector2f inside = min.array() + padding_;
  drawing_.rectangle(min, inside + Eigen::Vector2f(width + padding_, height + padding_), panel_ink);
  drawing_.text(title, whole(inside.x()), whole(inside.y()), letter_ink);
  // Half a line is left free above and below the bar, for the letters at its ends.
  const float top = std::round(inside.y() + std::ceil(title.height) + padding_ + 0.5f * line);
  const auto colours = legend.colours.size();
  for (int row = 0; row < static_cast<int>(bar_height); ++row) {
    const float at = 1.0f - (static_cast<float>(row) + 0.5f) / bar_height;
    const auto number = static_cast<std::size_t>(at * static_cast<float>(colours - 1) + 0.5f);
    const Colour& colour = legend.colours[number];
    const Eigen::Vector2f from = {inside.x(), top + static_cast<float>(row)};
    drawing_.rectangle(from, from + Eigen::Vector2f(bar_width, 1.0f),
                       {colour.x(), colour.y(), colour.z(), 1.0f});
  }
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const float y = top + (1.0f - legend.ticks[i].at) * bar_height;
    drawing_.text(ticks[i], whole(inside.x() + bar_width + padding_), whole(y - 0.5f * line),
                  letter_ink);
  }
}

}  // namespace pneuma::render
