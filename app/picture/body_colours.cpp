#include "app/picture/body_colours.h"

#include <algorithm>
#include <cmath>

#include "app/picture/srgb.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

using render::Colour;
using sim::Vec3;

// Colours are mixed as light: halfway between red and green lies the yellow of the paper's figures,
// where a mean of sRGB values is a dark brown.

/// Of a checked "#rrggbb".
Colour light_of(const std::string& hex) {
  Colour light;
  for (int channel = 0; channel < 3; ++channel) {
    const std::string digits = hex.substr(sim::at(1 + 2 * channel), 2);
    light[channel] = to_light(static_cast<float>(std::stoi(digits, nullptr, 16)) / 255.0f);
  }
  return light;
}

/// Where a point lies between two ends: 0..1; 0 when they coincide.
double share(double value, double low, double high) {
  return high > low ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0.0;
}

/// How far along the axis each vertex lies, 0..1.
std::vector<double> shares_along(std::span<const Vec3> vertices, const Vec3& axis) {
  std::vector<double> shares;
  for (const Vec3& vertex : vertices) shares.push_back(vertex.dot(axis));
  const auto [low, high] = std::minmax_element(shares.begin(), shares.end());
  for (const double from = *low, to = *high; double& value : shares) value = share(value, from, to);
  return shares;
}

/// The weights of the three colours: how far along x, y and z the vertex lies. The corner where all
/// three are 0 gets all colours alike, like the one where all are 1.
Vec3 weights(const Vec3& vertex, const sim::Bounds& bounds) {
  Vec3 weight;
  for (int axis = 0; axis < 3; ++axis) {
    weight[axis] = share(vertex[axis], bounds.low[axis], bounds.high[axis]);
  }
  const double sum = weight.sum();
  return sum > 0.0 ? Vec3(weight / sum) : Vec3::Constant(1.0 / 3.0);
}

}  // namespace

std::vector<Colour> body_colours(std::span<const Vec3> vertices,
                                 std::span<const std::string> colours, const Vec3& axis) {
  std::vector<Colour> lights;
  for (const std::string& colour : colours) lights.push_back(light_of(colour));

  std::vector<Colour> result(vertices.size(), lights.front());
  if (lights.size() == 2) {
    const std::vector<double> shares = shares_along(vertices, axis);
    for (std::size_t i = 0; i < result.size(); ++i) {
      const auto second = static_cast<float>(shares[i]);
      result[i] = (1.0f - second) * lights[0] + second * lights[1];
    }
  } else if (lights.size() == 3) {
    sim::Bounds bounds;
    for (const Vec3& vertex : vertices) bounds.include(vertex);
    for (std::size_t i = 0; i < result.size(); ++i) {
      const render::Vec3f weight = weights(vertices[i], bounds).cast<float>();
      result[i] = weight[0] * lights[0] + weight[1] * lights[1] + weight[2] * lights[2];
    }
  }
  for (Colour& colour : result) colour = colour.unaryExpr(&to_srgb);
  return result;
}

}  // namespace pneuma::app
