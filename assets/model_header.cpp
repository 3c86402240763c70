// What the first bytes of model files announce, held against what the files hold: the importer
// reserves memory for whatever a PLY, OFF or STL header asks for. And what it does not tell of
// files of text: the line of a number that is none.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>

#include "assets/model_file.h"
#include "sim/base/nearest.h"

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

constexpr std::string_view blanks = " \t\r\n";

bool is_number(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error != std::errc::invalid_argument && end == word.data() + word.size();
}

/// Goes through the words of a file, and knows where it is.
class Words {
 public:
  explicit Words(std::string_view file) : left_(file) {}

  /// Empty at the end. Comments, from # to the end of the line, are left out.
  std::string_view next() {
    skip(std::min(left_.find_first_not_of(blanks), left_.size()));
    while (left_.starts_with('#')) {
      skip_line();
      skip(std::min(left_.find_first_not_of(blanks), left_.size()));
    }
    const std::string_view word = left_.substr(0, left_.find_first_of(blanks));
    column_of_word_ = column_;
    skip(word.size());
    return word;
  }

  void skip_line() { skip(std::min(left_.find('\n'), left_.size())); }
  int line() const { return line_; }
  int column_of_word() const { return column_of_word_; }

 private:
  void skip(std::size_t count) {
    const std::string_view skipped = left_.substr(0, count);
    line_ += static_cast<int>(std::ranges::count(skipped, '\n'));
    const std::size_t line_end = skipped.rfind('\n');
    const bool is_same_line = line_end == skipped.npos;
    column_ = is_same_line ? column_ + static_cast<int>(count) : static_cast<int>(count - line_end);
    left_.remove_prefix(count);
  }

  std::string_view left_;
  int line_ = 1, column_ = 1;
  int column_of_word_ = 1;
};

std::string mistake(const Words& words, std::string_view word) {
  return fmt::format("{}:{}: {} is not a number", words.line(), words.column_of_word(),
                     base::in_quotes(word));
}

std::string first_mistake(Words& words) {
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (!is_number(word)) return mistake(words, word);
  }
  return {};
}

/// "ply", lines of words up to "end_header", then numbers alone if it is of text.
std::string ply_mistake(std::string_view file) {
  Words words(file);
  bool is_text = false;
  for (std::string_view word = words.next(); word != "end_header"; word = words.next()) {
    if (word.empty()) return {};
    if (word == "format") is_text = words.next() == "ascii";
    words.skip_line();
  }
  return is_text ? first_mistake(words) : std::string();
}

/// Each "vertex" and "normal" is followed by three numbers. Names are not looked at.
std::string stl_mistake(std::string_view file) {
  if (!file.starts_with("solid")) return {};
  Words words(file);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "solid" || word == "endsolid") words.skip_line();
    if (word != "vertex" && word != "normal") continue;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view number = words.next();
      if (number.empty()) {
        return fmt::format("the file ends within line {}, after a {}; it is cut short",
                           words.line(), word);
      }
      if (!is_number(number)) return mistake(words, number);
    }
  }
  return {};
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

std::string number_mistake(Format format, std::string_view file) {
  if (format == Format::ply) return ply_mistake(file);
  if (format == Format::stl) return stl_mistake(file);
  if (format != Format::off) return {};
  Words words(file);
  words.next();  // OFF
  return first_mistake(words);
}

}  // namespace pneuma::assets
