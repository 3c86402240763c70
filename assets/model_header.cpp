// What the first bytes of model files announce, held against what the files hold. The importer
// reserves memory for whatever a PLY, OFF or STL header asks for.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>

#include "assets/model_file.h"

namespace pneuma::assets {
namespace {

using Count = std::uint64_t;

struct Limits {
  Count vertices;
  Count triangles;
};

/// `min_bytes`: what one of them takes in the file at least.
void check_count(std::string_view what, Count count, Count most, Count min_bytes, Count bytes) {
  if (count > bytes / min_bytes) {
    throw ModelError(fmt::format(
        "the header announces {} {}, more than a file of {} bytes can hold; it is damaged or cut "
        "short",
        count, what, bytes));
  }
  if (count > most) {
    throw ModelError(fmt::format("{} {} are more than the limit of {} for a file; {}", count, what,
                                 most, how_to_keep_counts));
  }
}

std::optional<Count> read_count(std::istream& words) {
  std::string word;
  words >> word;
  if (word.empty() || word.size() > 18 || word.find_first_not_of("0123456789") != word.npos) {
    return std::nullopt;
  }
  return std::stoull(word);
}

[[noreturn]] void refuse_start(std::string_view format, std::string_view expected) {
  throw ModelError(fmt::format("this is not a file of the format {}: it does not begin with {}",
                               format, expected));
}

/// In a PLY file of text each element is a line after the header. The importer leaves out what is
/// missing.
void check_ply_lines(std::string_view body, Count announced) {
  Count lines = 0;
  while (!body.empty() && lines < announced) {
    const std::string_view line = body.substr(0, body.find_first_of("\r\n"));
    body.remove_prefix(std::min(line.size() + 1, body.size()));
    if (line.find_first_not_of(" \t") != line.npos) ++lines;
  }
  if (lines == announced) return;
  throw ModelError(
      fmt::format("the PLY header announces {} lines, one for each vertex, face or other element, "
                  "and there are "
                  "{}; the file is cut short",
                  announced, lines));
}

/// The lines up to "end_header".
void check_ply(std::string_view bytes, const Limits& limits) {
  constexpr std::size_t longest_header = 64 * 1024;
  const std::string_view start = bytes.substr(0, longest_header);
  if (!start.starts_with("ply")) refuse_start("PLY", "the word ply");
  const std::size_t end = start.find("end_header");
  if (end == start.npos) throw ModelError("the PLY header has no end_header; it is cut short");
  std::istringstream lines{std::string(start.substr(0, end))};
  bool vertices = false, faces = false, is_text = false;
  Count all = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first, name;
    words >> first >> name;
    is_text = is_text || (first == "format" && name == "ascii");
    if (first != "element") continue;
    const auto count = read_count(words);
    if (!count) throw ModelError(fmt::format("the PLY header's count of {} is no number", name));
    const Count most = name == "vertex" ? limits.vertices : limits.triangles;
    // Text: three digits with blanks; binary: at least three floats of two bytes. A face has a
    // count and three indices; what else there may be takes a byte or more.
    const Count min_bytes = name == "vertex" ? 6 : name == "face" ? 4 : 1;
    check_count(name == "vertex" ? "vertices"
                : name == "face" ? "faces"
                                 : "elements",
                *count, most, min_bytes, bytes.size());
    all += *count;
    vertices = vertices || (name == "vertex" && *count > 0);
    faces = faces || (name == "face" && *count > 0);
  }
  if (!vertices) throw ModelError("the model has no vertices");
  if (!faces) throw ModelError("the model has no triangles");
  if (is_text) check_ply_lines(bytes.substr(end + std::string_view("end_header").size()), all);
}

/// "OFF", perhaps with letters before it for colours, normals or texture coordinates, then three
/// counts. The importer knows plain text only, and comments are taken out before.
void check_off(std::string_view bytes, const Limits& limits) {
  constexpr std::size_t most_letters = 4;
  const std::size_t word = bytes.substr(0, most_letters + 3).find("OFF");
  if (word == bytes.npos) refuse_start("OFF", "the word OFF");
  std::istringstream text{std::string(bytes.substr(word + 3, 64 * 1024))};
  std::string counts;
  while (counts.find_first_not_of(" \t\r") == counts.npos && std::getline(text, counts)) {
  }
  std::istringstream words(counts);
  const auto vertices = read_count(words);
  const auto faces = read_count(words);
  if (!vertices || !faces) {
    throw ModelError("the OFF header does not say how many vertices and faces there are");
  }
  check_count("vertices", *vertices, limits.vertices, 6, bytes.size());
  check_count("faces", *faces, limits.triangles, 8, bytes.size());
  if (*vertices == 0) throw ModelError("the model has no vertices");
  if (*faces == 0) throw ModelError("the model has no triangles");
}

/// 80 bytes of anything, a count, 50 bytes per triangle; or a text that begins with "solid" and has
/// a "facet". Some binary files begin with "solid" too.
void check_stl(std::string_view bytes, const Limits& limits) {
  constexpr std::size_t header = 84, per_triangle = 50;
  if (bytes.starts_with("solid") && bytes.substr(0, 1024).find("facet") != bytes.npos) return;
  if (bytes.size() < header) throw ModelError("the STL file is cut short within its header");
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  if (count == 0) throw ModelError("the model has no triangles");
  check_count("triangles", count, limits.triangles, per_triangle, bytes.size() - header);
}

void check_start(std::string_view bytes, std::string_view start, std::string_view format) {
  if (!bytes.starts_with(start)) refuse_start(format, fmt::format("'{}'", start));
}

void check_3ds(std::string_view bytes) {
  if (!bytes.starts_with("\x4d\x4d")) refuse_start("3DS", "its main chunk, the bytes 4d 4d");
}

/// A text has no zero bytes; blanks and a byte order mark may come first.
void check_text(std::string_view bytes, std::string_view format, char first) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  if (bytes.find('\0') != bytes.npos) {
    throw ModelError(fmt::format(
        "this is not a file of the format {}: it is not a text of 8-bit characters, such as UTF-8",
        format));
  }
  if (first != '\0' && (start == bytes.npos || bytes[start] != first)) {
    refuse_start(format, fmt::format("'{}'", first));
  }
}

}  // namespace

std::string without_comments(std::string_view off) {
  std::string text;
  text.reserve(off.size());
  while (!off.empty()) {
    const std::size_t end = std::min(off.find('\n'), off.size() - 1) + 1;
    const std::string_view line = off.substr(0, end);
    off.remove_prefix(end);
    const std::string_view said = line.substr(0, std::min(line.find('#'), end));
    if (said.find_first_not_of(" \t\r\n") == said.npos) continue;
    text += said;
    if (said.back() != '\n') text += '\n';
  }
  return text;
}

void check_model_header(Format format, std::string_view bytes, std::size_t max_vertices,
                        std::size_t max_triangles) {
  const Limits limits{max_vertices, max_triangles};
  switch (format) {
    case Format::ply:
      return check_ply(bytes, limits);
    case Format::off:
      return check_off(bytes, limits);
    case Format::stl:
      return check_stl(bytes, limits);
    case Format::glb:
      return check_start(bytes, "glTF", "GLB");
    case Format::a3ds:
      return check_3ds(bytes);
    case Format::obj:
      return check_text(bytes, "OBJ", '\0');
    case Format::gltf:
      return check_text(bytes, "glTF", '{');
    case Format::dae:
      return check_text(bytes, "DAE", '<');
    case Format::fbx:  // binary, or a text that begins with a comment
      if (!bytes.starts_with("Kaydara FBX Binary")) check_text(bytes, "FBX", ';');
      return;
  }
}

}  // namespace pneuma::assets
