#include "assets/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace pneuma::assets {
namespace {

constexpr std::array<std::pair<std::string_view, Format>, 9> endings = {{
    {".obj", Format::obj},
    {".ply", Format::ply},
    {".stl", Format::stl},
    {".off", Format::off},
    {".gltf", Format::gltf},
    {".glb", Format::glb},
    {".3ds", Format::a3ds},
    {".dae", Format::dae},
    {".fbx", Format::fbx},
}};

std::string lower_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

const std::pair<std::string_view, Format>* find_ending(const std::filesystem::path& path) {
  const std::string ending = lower_ending(path);
  const auto* found = std::find_if(endings.begin(), endings.end(),
                                   [&](const auto& known) { return known.first == ending; });
  return found == endings.end() ? nullptr : found;
}

/// `known` of its bytes were read; a pipe may have more, and does not say.
[[noreturn]] void refuse_size(const std::filesystem::path& path, std::size_t most_bytes,
                              std::size_t read_before, std::size_t known) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  throw ModelError(fmt::format(
      "{} bytes{} are more than the limit of {} for a model{}; simplify the model (or, in a scene, "
      "raise model_file_mib in [limits])",
      read_before + (error ? known : size), error ? " and more" : "", most_bytes,
      read_before > 0 ? " with its files" : ""));
}

}  // namespace

bool has_model_ending(const std::filesystem::path& path) { return find_ending(path) != nullptr; }

std::string model_endings() {
  std::string text;
  for (std::size_t i = 0; i < endings.size(); ++i) {
    if (i > 0) text += i + 1 == endings.size() ? " or " : ", ";
    text += endings[i].first.substr(1);
  }
  return text;
}

Format format_of(const std::filesystem::path& path) {
  if (const auto* found = find_ending(path)) return found->second;
  throw ModelError(fmt::format("the ending '{}' is none of a model's; allowed: {}",
                               path.extension().string(), model_endings()));
}

std::string read_model_file(const std::filesystem::path& path, std::size_t most_bytes,
                            std::size_t read_before) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw ModelError("is a folder; name a model file in it");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw ModelError(fmt::format("cannot be opened: {}", std::strerror(errno)));
  // In pieces, and one byte more than is allowed: the size of a pipe is not known beforehand.
  constexpr std::size_t piece = 1024 * 1024;
  const std::size_t left = most_bytes - read_before;
  std::string bytes;
  while (file && bytes.size() <= left) {
    const std::size_t before = bytes.size();
    const std::size_t wanted = std::min(piece, left + 1 - before);
    bytes.resize(before + wanted);
    file.read(bytes.data() + before, static_cast<std::streamsize>(wanted));
    bytes.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw ModelError(fmt::format("cannot be read: {}", std::strerror(errno)));
  if (bytes.size() > left) refuse_size(path, most_bytes, read_before, bytes.size());
  if (bytes.empty()) throw ModelError("the file is empty");
  return bytes;
}

}  // namespace pneuma::assets
