#include "assets/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>

#include "sim/base/file.h"

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

/// What a DAE says about itself comes first, its meshes after that.
std::string beginning(const std::filesystem::path& path) {
  std::string text(std::size_t{1} << 16, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

[[noreturn]] void refuse_size(const base::FileTooLarge& error, std::size_t max_bytes,
                              std::size_t read_before) {
  throw ModelError(fmt::format(
      "{} are more than the limit of {} for a model{}; simplify the model, or raise "
      "model_file_mib in [limits] (--set limits.model_file_mib=N)",
      error.size_text(read_before), max_bytes, read_before == 0 ? "" : " with its files"));
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

std::string_view up_axis(const std::filesystem::path& path) {
  switch (format_of(path)) {
    case Format::gltf:
    case Format::glb:
      return "y";
    case Format::dae: {
      const std::string text = beginning(path);
      const std::size_t tag = text.find("<up_axis>");
      if (tag == text.npos) return "y";
      const std::string said = text.substr(tag, text.find("</", tag) - tag);
      if (said.find("Z_UP") != said.npos) return "z";
      return said.find("X_UP") != said.npos ? "x" : "y";
    }
    default:
      return "z";
  }
}

std::string read_model_file(const std::filesystem::path& path, std::size_t max_bytes,
                            std::size_t read_before) {
  std::string bytes;
  try {
    bytes = base::read_text_file(path.string(),
                                 {.max_bytes = max_bytes - read_before, .what = "model file"});
  } catch (const base::FileTooLarge& error) {
    refuse_size(error, max_bytes, read_before);
  } catch (const base::ReadError& error) {
    throw ModelError(error.reason());
  }
  if (bytes.empty()) throw ModelError("the file is empty");
  return bytes;
}

}  // namespace pneuma::assets
