#include "app/picture/colour_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/soft/gas_law.h"

namespace pneuma::app {
namespace {

using render::Colour;
using sim::Vec3;

// At 0, 1/9, ... 1: straight lines between them stay within 2 of 255.
constexpr std::array<std::array<int, 3>, 10> viridis_colours = {{{68, 1, 84},
                                                                 {72, 40, 120},
                                                                 {62, 74, 137},
                                                                 {49, 104, 142},
                                                                 {38, 130, 142},
                                                                 {31, 158, 137},
                                                                 {53, 183, 121},
                                                                 {109, 205, 89},
                                                                 {180, 222, 44},
                                                                 {253, 231, 37}}};
const Colour no_value = {0.62f, 0.62f, 0.64f};

Colour colour_of(const std::array<int, 3>& bytes) {
  return Colour(static_cast<float>(bytes[0]), static_cast<float>(bytes[1]),
                static_cast<float>(bytes[2])) /
         255.0f;
}

std::vector<double> strains(const sim::SoftBody& body) {
  std::vector<double> result(static_cast<std::size_t>(body.positions.size()), 0.0);
  const auto& edges = body.mesh->topology.edges();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double rest = body.mesh->rest_lengths[e];
    if (rest <= 0.0) continue;
    const auto& [a, b] = edges[e];
    const double strain =
        std::abs(Vec3(body.positions[a] - body.positions[b]).norm() - rest) / rest;
    for (const int v : {a, b}) result[sim::at(v)] = std::max(result[sim::at(v)], strain);
  }
  return result;
}

std::vector<double> speeds(const sim::SoftBody& body) {
  std::vector<double> result;
  for (int v = 0; v < body.velocities.size(); ++v) {
    result.push_back(Vec3(body.velocities[v]).norm());
  }
  return result;
}

std::vector<double> speeds(const sim::RigidBox& box) {
  std::vector<double> result;
  for (const Vec3& corner : sim::make_box(box.size, 1).vertices) {
    const Vec3 arm = box.orientation * corner;
    result.push_back(Vec3(box.velocity + box.angular_velocity.cross(arm)).norm());
  }
  return result;
}

/// Empty for a body without gas, or without a volume for it.
std::vector<double> pressures(const sim::SoftBody& body) {
  const double volume = sim::volume(body.mesh->topology, body.positions);
  if (body.material.n <= 0.0 || volume <= 0.0) return {};
  return std::vector<double>(static_cast<std::size_t>(body.positions.size()),
                             sim::gauge_pressure(sim::gas_law(body.material), volume));
}

std::string title_of(ColourField field) {
  switch (field) {
    case ColourField::strain:
      return "strain";
    case ColourField::velocity:
      return "speed, m/s";
    case ColourField::pressure:
      return "pressure, Pa";
    case ColourField::none:
      break;
  }
  return "";
}

render::Legend legend_of(const Show& show, double end) {
  constexpr int colours = 64;
  constexpr int ticks = 4;
  render::Legend legend;
  legend.title = title_of(show.field) + (show.field_end_grows ? ", run so far" : "");
  for (int i = 0; i < colours; ++i) {
    legend.colours.push_back(viridis(static_cast<double>(i) / (colours - 1)));
  }
  for (int i = 0; i <= ticks; ++i) {
    const double at = static_cast<double>(i) / ticks;
    const std::string text = show.field == ColourField::strain
                                 ? fmt::format("{:g} %", 100.0 * at * end)
                                 : fmt::format("{:g}", at * end);
    legend.ticks.push_back({static_cast<float>(at), text});
  }
  return legend;
}

}  // namespace

Colour viridis(double part) {
  constexpr std::size_t last = viridis_colours.size() - 1;
  const double place = std::clamp(part, 0.0, 1.0) * last;
  const auto first = std::min(static_cast<std::size_t>(place), last - 1);
  const auto rest = static_cast<float>(place - static_cast<double>(first));
  return (1.0f - rest) * colour_of(viridis_colours[first]) +
         rest * colour_of(viridis_colours[first + 1]);
}

std::vector<std::vector<double>> field_values(const sim::World& world, ColourField field) {
  std::vector<std::vector<double>> result;
  for (const sim::SoftBody& body : world.soft) {
    switch (field) {
      case ColourField::strain:
        result.push_back(strains(body));
        break;
      case ColourField::velocity:
        result.push_back(speeds(body));
        break;
      case ColourField::pressure:
        result.push_back(pressures(body));
        break;
      case ColourField::none:
        result.emplace_back();
    }
  }
  for (const sim::RigidBox& box : world.rigid) {
    result.push_back(field == ColourField::velocity ? speeds(box) : std::vector<double>());
  }
  return result;
}

double greatest(const std::vector<std::vector<double>>& values) {
  double result = 0.0;
  for (const std::vector<double>& body : values) {
    for (const double value : body) result = std::max(result, value);
  }
  return result;
}

double round_end(double value) {
  constexpr double rounding = 1e-9;  // % (strain), m/s, Pa, at most
  if (!(value > rounding)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value * (1.0 - 1e-12)) return factor * power;
  }
  return 10.0 * power;
}

void add_field(const sim::World& world, const Show& show, render::Frame& frame) {
  const auto values = field_values(world, show.field);
  const double end = show.field_end.value_or(round_end(greatest(values)));
  for (std::size_t i = 0; i < frame.meshes.size(); ++i) {
    render::Mesh& mesh = frame.meshes[i];
    mesh.roughness = 1.0f;  // so that no highlight hides a colour
    // The meshes of springs and valves come after those of the bodies. Bars have other vertices.
    if (i >= values.size() || values[i].size() != mesh.positions.size()) {
      mesh.colours.assign(mesh.positions.size(), no_value);
      continue;
    }
    for (const double value : values[i]) mesh.colours.push_back(viridis(value / end));
  }
  frame.legend = legend_of(show, end);
}

}  // namespace pneuma::app
