#include "app/export/npz_writer.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <utility>

namespace pneuma::app {
namespace {

/// What a zip archive says of an entry twice: before its bytes, and in the directory at the end.
/// The same bytes for the same run: the date is always zip's first day, 1980-01-01.
Bytes entry_header(const std::string& file, std::uint32_t checksum, std::uint32_t size) {
  Bytes header;
  put(header, std::uint16_t{20});          // needs version 2.0
  put(header, std::uint16_t{0});           // flags
  put(header, std::uint16_t{0});           // stored
  put(header, std::uint16_t{0});           // time
  put(header, std::uint16_t{1 << 5 | 1});  // date
  put(header, checksum);
  put(header, size);  // compressed
  put(header, size);
  put(header, static_cast<std::uint16_t>(file.size()));
  put(header, std::uint16_t{0});  // no extra field
  return header;
}

/// Version 1.0 of numpy.lib.format: padded, so that the values begin at a multiple of 64.
Bytes npy_header(const std::string& type, std::initializer_list<std::size_t> shape) {
  std::string sizes;
  for (const std::size_t size : shape) sizes += fmt::format("{}, ", size);
  std::string text =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, sizes);
  constexpr std::size_t preamble = 10;
  while ((preamble + text.size() + 1) % 64 != 0) text += ' ';
  text += '\n';
  Bytes header;
  put(header, std::string("\x93NUMPY\x01\x00", 8));
  put(header, static_cast<std::uint16_t>(text.size()));
  put(header, text);
  return header;
}

void append(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

}  // namespace

void NpzWriter::add(const std::string& name, const std::string& type,
                    std::initializer_list<std::size_t> shape, const Bytes& values) {
  const std::string file = name + ".npy";
  const Bytes header = npy_header(type, shape);
  const std::uint32_t checksum = libdeflate_crc32(libdeflate_crc32(0, header.data(), header.size()),
                                                  values.data(), values.size());
  const Bytes entry =
      entry_header(file, checksum, static_cast<std::uint32_t>(header.size() + values.size()));
  const auto offset = static_cast<std::uint32_t>(archive_.size());

  put(archive_, std::uint32_t{0x04034b50});
  append(archive_, entry);
  put(archive_, file);
  append(archive_, header);
  append(archive_, values);

  put(directory_, std::uint32_t{0x02014b50});
  put(directory_, std::uint16_t{20});  // made by version 2.0
  append(directory_, entry);
  put(directory_, std::uint16_t{0});  // no comment
  put(directory_, std::uint16_t{0});  // first disk
  put(directory_, std::uint16_t{0});  // internal attributes
  put(directory_, std::uint32_t{0});  // external attributes
  put(directory_, offset);
  put(directory_, file);
  ++arrays_;
}

Bytes NpzWriter::finish() {
  const auto offset = static_cast<std::uint32_t>(archive_.size());
  append(archive_, directory_);
  put(archive_, std::uint32_t{0x06054b50});
  put(archive_, std::uint16_t{0});  // this disk
  put(archive_, std::uint16_t{0});  // the directory's disk
  put(archive_, arrays_);           // on this disk
  put(archive_, arrays_);
  put(archive_, static_cast<std::uint32_t>(directory_.size()));
  put(archive_, offset);
  put(archive_, std::uint16_t{0});  // no comment
  return std::move(archive_);
}

}  // namespace pneuma::app
