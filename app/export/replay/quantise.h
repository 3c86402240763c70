// Positions as 16-bit integers, and series of them as bytes that deflate makes small.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/frame/frame.h"

namespace pneuma::app {

/// position = origin + step * integer, along each axis. A position in the box that the lattice was
/// made for is half a step away at most; one beyond becomes the nearest within.
struct Lattice {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // m
  double extent = 0.0;                               // m, the box's longest side
  double step = 1.0;                                 // m

  std::uint16_t nearest(float coordinate, int axis) const;
};

/// `low`, `high`: the box's corners.
Lattice lattice_over(const render::Vec3f& low, const render::Vec3f& high);

/// What foretells a value: the same column of the row before, which suits points in no order, or a
/// straight line through that of the two rows before (the row before in the second row), which
/// suits what moves.
enum class Foretold { by_row, by_line };

/// The rows of a table that change little from one to the next: each value minus what is foretold,
/// modulo 65536; of that n, 2 |n|, minus 1 where n < 0 (zigzag); first all low bytes, then all high
/// ones.
std::vector<std::uint8_t> differences(std::span<const std::uint16_t> values, std::size_t columns,
                                      Foretold foretold);

/// zlib's format, as small as libdeflate can make it.
std::vector<std::uint8_t> deflate(std::span<const std::uint8_t> bytes);

}  // namespace pneuma::app
