// NumPy's .npz: a zip archive of arrays in its .npy format, not compressed.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "app/export/sink/bytes.h"

namespace pneuma::app {

/// Bytes of all arrays together: 32-bit offsets, as in archives without the zip64 extension.
inline constexpr std::uint64_t max_npz_bytes = 0xffff'ffff;

class NpzWriter {
 public:
  /// `type` is what NumPy calls the values, "<f8" for example; the last index of `shape` runs
  /// fastest.
  void add(const std::string& name, const std::string& type,
           std::initializer_list<std::size_t> shape, const Bytes& values);

  /// The whole file. Nothing may be added after it.
  Bytes finish();

 private:
  Bytes archive_;
  Bytes directory_;
  std::uint16_t arrays_ = 0;
};

}  // namespace pneuma::app
