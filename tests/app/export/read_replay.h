// What a replay page holds, read by code of its own.
#pragma once

#include <libdeflate.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace pneuma {

/// The text of the page's element with this id.
inline std::string element_text(const std::string& page, const std::string& id) {
  const std::size_t opening = page.find("id=\"" + id + "\"");
  if (opening == std::string::npos) throw std::runtime_error("the page has no " + id);
  const std::size_t begin = page.find('>', opening) + 1;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

inline std::vector<std::uint8_t> from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    if (letter == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(letter));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count & 255u));
  }
  return bytes;
}

class ReadReplay {
 public:
  explicit ReadReplay(const std::string& page)
      : header(nlohmann::json::parse(element_text(page, "header"))) {
    const std::vector<std::uint8_t> packed = from_base64(element_text(page, "data"));
    bytes_.resize(std::size_t{64} << 20);
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>
        decompressor(libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
    std::size_t size = 0;
    if (libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(), bytes_.data(),
                                   bytes_.size(), &size) != LIBDEFLATE_SUCCESS) {
      throw std::runtime_error("the page's data cannot be unpacked");
    }
    bytes_.resize(size);
  }

  template <class Value>
  std::vector<Value> series(const std::string& name) const {
    const nlohmann::json& stream = header.at("streams").at(name);
    std::vector<Value> values(stream.at("count").get<std::size_t>());
    if (values.empty()) return values;
    std::memcpy(values.data(), bytes_.data() + stream.at("offset").get<std::size_t>(),
                values.size() * sizeof(Value));
    return values;
  }

  /// Coordinates in metres, of a series of quantised ones.
  std::vector<double> coordinates(const std::string& name) const {
    const nlohmann::json& stream = header.at("streams").at(name);
    const auto count = stream.at("count").get<std::size_t>();
    const bool by_line = stream.at("kind") == "differences_by_line";
    const auto columns = stream.at("columns").get<std::size_t>();
    const std::uint8_t* low = bytes_.data() + stream.at("offset").get<std::size_t>();
    const nlohmann::json& lattice = header.at("lattice");
    std::vector<long> integers;
    std::vector<double> metres;
    for (std::size_t i = 0; i < count; ++i) {
      const long folded = low[i] + 256L * low[count + i];
      const long residual = folded % 2 == 0 ? folded / 2 : -(folded + 1) / 2;
      const long last = i < columns ? 0 : integers[i - columns];
      const long slope = !by_line || i < 2 * columns ? 0 : last - integers[i - 2 * columns];
      integers.push_back(((last + slope + residual) % 65536 + 65536) % 65536);
      metres.push_back(lattice["origin"][i % 3].get<double>() +
                       lattice["step"].get<double>() * static_cast<double>(integers.back()));
    }
    return metres;
  }

  nlohmann::json header;

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace pneuma
