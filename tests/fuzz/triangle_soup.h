// Triangles without order, as bytes: any bytes are some triangles, and bytes that change a little
// make triangles that change a little.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "assets/clean_mesh.h"

namespace pneuma::fuzz {

using Byte = std::uint8_t;

/// One byte of options, one with the number of vertices, then the arrays.
struct TriangleSoup {
  Byte options = 0;
  std::vector<std::array<Byte, 6>> vertices;   // two bytes a coordinate: coordinate_of
  std::vector<std::array<Byte, 3>> triangles;  // indices modulo the number of vertices, mostly
};

inline constexpr std::size_t most_soup_vertices = 255;

TriangleSoup decode(std::string_view bytes);
std::string encode(const TriangleSoup& soup);

/// The coarse byte counts eighths, from -16 to 16. The fine byte adds next to nothing, multiplies
/// by a power of ten, or makes it something that is no number.
double coordinate_of(Byte coarse, Byte fine);

assets::Model model_of(const TriangleSoup& soup);
assets::CleanOptions clean_options_of(const TriangleSoup& soup);

/// Of a mesh with coordinates within +-15.
TriangleSoup soup_of(const sim::TriangleMesh& mesh);

}  // namespace pneuma::fuzz
