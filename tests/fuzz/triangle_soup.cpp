#include "tests/fuzz/triangle_soup.h"

#include <cmath>
#include <limits>

namespace pneuma::fuzz {
namespace {

using sim::at;

template <std::size_t count>
std::vector<std::array<Byte, count>> take(std::string_view& bytes, std::size_t most) {
  std::vector<std::array<Byte, count>> result(std::min(most, bytes.size() / count));
  for (auto& element : result) {
    for (std::size_t i = 0; i < count; ++i) element[i] = static_cast<Byte>(bytes[i]);
    bytes.remove_prefix(count);
  }
  return result;
}

template <class Elements>
void append(std::string& bytes, const Elements& elements) {
  for (const auto& element : elements) {
    for (const Byte byte : element) bytes += static_cast<char>(byte);
  }
}

/// The last few of a byte's values stand for indices out of range.
int index_of(Byte byte, std::size_t vertex_count) {
  constexpr std::array<int, 4> wrong = {-1, 255, std::numeric_limits<int>::max(),
                                        std::numeric_limits<int>::min()};
  constexpr std::size_t first_wrong = 256 - wrong.size();
  if (byte >= first_wrong) return wrong[byte - first_wrong];
  return vertex_count == 0 ? 0 : static_cast<int>(byte % vertex_count);
}

}  // namespace

TriangleSoup decode(std::string_view bytes) {
  TriangleSoup soup;
  if (bytes.size() < 2) return soup;
  soup.options = static_cast<Byte>(bytes[0]);
  const std::size_t vertices = static_cast<Byte>(bytes[1]);
  bytes.remove_prefix(2);
  soup.vertices = take<6>(bytes, vertices);
  soup.triangles = take<3>(bytes, bytes.size());
  return soup;
}

std::string encode(const TriangleSoup& soup) {
  std::string bytes;
  bytes += static_cast<char>(soup.options);
  bytes += static_cast<char>(soup.vertices.size());
  append(bytes, soup.vertices);
  append(bytes, soup.triangles);
  return bytes;
}

double coordinate_of(Byte coarse, Byte fine) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr std::array<double, 5> strange = {std::numeric_limits<double>::quiet_NaN(), infinity,
                                             -infinity, std::numeric_limits<double>::max(),
                                             std::numeric_limits<double>::denorm_min()};
  constexpr Byte last_offset = 120;
  constexpr Byte first_strange = 256 - strange.size();
  const double base = (coarse - 128) / 8.0;
  if (fine == 0) return base;
  // Down to 2^-60: below the tolerance of welding (1e-6) and the grid of exact tests (2^-30).
  if (fine <= last_offset) return base + std::ldexp(fine % 2 == 0 ? 1.0 : -1.0, -fine / 2);
  if (fine < first_strange) return base * std::pow(10.0, fine - 186);  // 1e-65 to 1e64
  return strange[fine - first_strange];
}

assets::Model model_of(const TriangleSoup& soup) {
  assets::Model model;
  for (const auto& v : soup.vertices) {
    model.mesh.vertices.emplace_back(coordinate_of(v[0], v[1]), coordinate_of(v[2], v[3]),
                                     coordinate_of(v[4], v[5]));
  }
  for (const auto& [a, b, c] : soup.triangles) {
    const std::size_t count = soup.vertices.size();
    model.mesh.triangles.push_back({index_of(a, count), index_of(b, count), index_of(c, count)});
  }
  if ((soup.options & 0x80) != 0) {
    model.part_names = {"left", "right"};
    for (const auto& triangle : soup.triangles) model.parts.push_back(triangle[0] / 64);
  }
  return model;
}

assets::CleanOptions clean_options_of(const TriangleSoup& soup) {
  constexpr std::array<double, 4> scales = {1.0, 0.3, 1e5, 1e-5};
  constexpr std::array<const char*, 4> components = {"", "1", "2", "right"};
  assets::CleanOptions options;
  options.scale = scales[soup.options & 3];
  options.component = components[(soup.options >> 2) & 3];
  if ((soup.options & 0x10) != 0) options.rotation = {10.0, -200.0, 77.0};
  options.centre = (soup.options & 0x20) == 0;
  if ((soup.options & 0x40) != 0) options.most_vertices = 12;
  return options;
}

TriangleSoup soup_of(const sim::TriangleMesh& mesh) {
  TriangleSoup soup;
  for (const sim::Vec3& vertex : mesh.vertices) {
    std::array<Byte, 6> bytes = {};
    for (int i = 0; i < 3; ++i) {
      bytes[at(2 * i)] = static_cast<Byte>(std::lround(8.0 * vertex[i]) + 128);
    }
    soup.vertices.push_back(bytes);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    soup.triangles.push_back({static_cast<Byte>(a), static_cast<Byte>(b), static_cast<Byte>(c)});
  }
  return soup;
}

}  // namespace pneuma::fuzz
