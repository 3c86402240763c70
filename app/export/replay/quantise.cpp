#include "app/export/replay/quantise.h"

#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>

namespace pneuma::app {
namespace {

constexpr double last_integer = std::numeric_limits<std::uint16_t>::max();
constexpr int deflate_level = 12;  // the smallest; the page of a scene takes it a second

std::uint16_t zigzag(int difference) {
  const auto wrapped = static_cast<std::int16_t>(difference);
  return static_cast<std::uint16_t>(wrapped < 0 ? -2 * wrapped - 1 : 2 * wrapped);
}

}  // namespace

std::uint16_t Lattice::nearest(float coordinate, int axis) const {
  const double integer = std::round((static_cast<double>(coordinate) - origin[axis]) / step);
  return static_cast<std::uint16_t>(std::clamp(integer, 0.0, last_integer));
}

Lattice lattice_over(const render::Vec3f& low, const render::Vec3f& high) {
  Lattice lattice;
  lattice.origin = low.cast<double>();
  lattice.extent = (high.cast<double>() - lattice.origin).maxCoeff();
  if (lattice.extent > 0.0) lattice.step = lattice.extent / last_integer;
  return lattice;
}

std::vector<std::uint8_t> differences(std::span<const std::uint16_t> values, std::size_t columns,
                                      Foretold foretold) {
  std::vector<std::uint8_t> planes(2 * values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    int expected = 0;
    if (i >= columns) expected = values[i - columns];
    if (foretold == Foretold::by_line && i >= 2 * columns) {
      expected = 2 * expected - values[i - 2 * columns];
    }
    const std::uint16_t value = zigzag(values[i] - expected);
    planes[i] = static_cast<std::uint8_t>(value & 0xFF);
    planes[values.size() + i] = static_cast<std::uint8_t>(value >> 8);
  }
  return planes;
}

std::vector<std::uint8_t> deflate(std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(deflate_level), &libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::vector<std::uint8_t> packed(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  packed.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(),
                                         packed.data(), packed.size()));
  return packed;
}

}  // namespace pneuma::app
