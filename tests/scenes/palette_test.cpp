// Bodies without colours of their own can be told apart, also by people with colour blindness.
#include "scenes/loader/palette.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <set>

#include "scenes/loader/load_scene.h"

namespace pneuma::scenes {
namespace {

using Eigen::Array3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d light_of(const std::string& hex) {
  Vector3d light;
  for (int i = 0; i < 3; ++i) {
    const double c = std::stoi(hex.substr(static_cast<std::size_t>(1 + 2 * i), 2), nullptr, 16);
    light[i] =
        c / 255.0 <= 0.04045 ? c / 255.0 / 12.92 : std::pow((c / 255.0 + 0.055) / 1.055, 2.4);
  }
  return light;
}

/// CIE L*a*b* of linear sRGB under D65.
Vector3d lab(const Vector3d& light) {
  Matrix3d to_xyz;
  to_xyz << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Array3d xyz = (to_xyz * light.cwiseMax(0.0)).array() / Array3d(0.9505, 1.0, 1.089);
  const Array3d f = xyz.unaryExpr(
      [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; });
  return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

/// What is seen without one kind of cones (Machado, Oliveira and Fernandes, 2009, severity 1).
std::vector<Matrix3d> kinds_of_sight() {
  Matrix3d protan;
  protan << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
      1.051998;
  Matrix3d deutan;
  deutan << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
      0.968881;
  Matrix3d tritan;
  tritan << 1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367,
      0.303900;
  return {Matrix3d::Identity(), protan, deutan, tritan};
}

TEST(Palette, CanBeToldApartInEveryKindOfSight) {
  // A difference of 2.3 is just noticeable side by side; three times as much is told at a glance.
  for (const Matrix3d& sight : kinds_of_sight()) {
    for (std::size_t a = 0; a < palette_size(); ++a) {
      for (std::size_t b = a + 1; b < palette_size(); ++b) {
        for (const std::size_t tone : {0u, 1u}) {
          const Vector3d first = lab(sight * light_of(palette_colours(a)[tone]));
          const Vector3d second = lab(sight * light_of(palette_colours(b)[tone]));
          EXPECT_GT((first - second).norm(), 7.0) << a << ' ' << b << " tone " << tone;
        }
      }
    }
  }
}

TEST(Palette, GivesEachBodyOfASceneItsOwnColour) {
  std::string text;
  for (std::size_t i = 0; i < palette_size(); ++i) text += "[[body]]\n";
  const Scene scene = parse_scene(text, "seven.toml");
  std::set<std::vector<std::string>> colours;
  for (const BodyScene& body : scene.bodies) colours.insert(body.colours);
  EXPECT_EQ(colours.size(), palette_size());
  EXPECT_EQ(palette_colours(palette_size()), palette_colours(0));
}

}  // namespace
}  // namespace pneuma::scenes
