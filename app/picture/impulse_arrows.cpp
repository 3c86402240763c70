#include "app/picture/impulse_arrows.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/picture/colour_field.h"
#include "app/picture/overlay.h"

namespace pneuma::app {
namespace {

using render::Colour;
using render::Vec3f;

const Colour arrow_colour(0.08f, 0.08f, 0.12f);  // seen on ground and palette alike
constexpr float shaft_width = 3.0f;              // pixels at 480 lines
constexpr float foot_diameter = 6.0f;            // likewise
constexpr float most_of_picture = 0.2f;
constexpr float head_of_arrow = 0.3f;
constexpr float head_of_picture = 0.03f;

/// m, of the picture where the camera's target is.
float picture_height(const render::Camera& camera) {
  const float half = 0.5f * camera.field_of_view * std::numbers::pi_v<float> / 180.0f;
  return 2.0f * std::tan(half) * (camera.eye - camera.target).norm();
}

void add_arrow(const Vec3f& foot, const Vec3f& arrow, render::Frame& frame) {
  const Vec3f tip = foot + arrow;
  const auto add_line = [&](const Vec3f& from) {
    frame.lines.push_back({from, tip, arrow_colour, shaft_width, true});
  };
  add_line(foot);
  const Vec3f across = arrow.cross(frame.camera.eye - tip);
  const float size = across.norm();
  if (size == 0.0f) return;
  const float length = arrow.norm();
  const float head =
      std::min(head_of_arrow * length, head_of_picture * picture_height(frame.camera));
  const Vec3f back = tip - head / length * arrow;
  for (const float side : {-0.6f, 0.6f}) add_line(back + side * head / size * across);
}

}  // namespace

double arrow_scale(std::span<const sim::Contact> contacts, const render::Camera& camera) {
  double max = 0.0;
  for (const sim::Contact& contact : contacts) max = std::max(max, contact.impulse.norm());
  return round_end(max / static_cast<double>(most_of_picture * picture_height(camera)));
}

void add_impulses(std::span<const sim::Contact> contacts, double scale, render::Frame& frame) {
  for (const sim::Contact& contact : contacts) {
    const Vec3f foot = contact.point.cast<float>();
    const Vec3f arrow = (contact.impulse / scale).cast<float>();
    frame.points.push_back({foot, contact_colour(contact), foot_diameter});
    if (arrow.norm() > 0.0f) add_arrow(foot, arrow, frame);
  }
}

std::string arrow_legend(double scale, int steps_per_second) {
  return fmt::format("\narrows: 1 m is an impulse of {:g} N s in a step of 1/{} s", scale,
                     steps_per_second);
}

}  // namespace pneuma::app
