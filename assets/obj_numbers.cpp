#include "assets/obj_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "assets/weld.h"
#include "sim/mesh/measure.h"

namespace pneuma::assets {
namespace {

/// Of the extent: the importer reads single precision.
constexpr double same_place = 1e-6;

/// A line of the file, and its number.
struct Line {
  const std::string& text;
  int number = 0;
};

/// Calls with the letter, the rest and all of each line "v ..." and "f ...".
template <class Visit>
void for_each_line(std::string_view file, const Visit& visit) {
  int number = 0;
  for (std::size_t begin = 0; begin < file.size();) {
    const std::size_t end = std::min(file.find('\n', begin), file.size());
    const std::string line(file.substr(begin, end - begin));
    begin = end + 1;
    ++number;
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == line.npos || first + 1 == line.size()) continue;
    const bool is_one = line[first] == 'v' || line[first] == 'f';
    if (!is_one || (line[first + 1] != ' ' && line[first + 1] != '\t')) continue;
    visit(line[first], line.c_str() + first + 1, Line{line, number});
  }
}

/// The lines "v x y z".
std::vector<Vec3> vertices_of(std::string_view file) {
  std::vector<Vec3> vertices;
  for_each_line(file, [&](char letter, const char* text, const Line&) {
    if (letter != 'v') return;
    Vec3 vertex;
    for (int axis = 0; axis < 3; ++axis) {
      char* after = nullptr;
      vertex[axis] = std::strtod(text, &after);
      text = after;
    }
    vertices.push_back(vertex);
  });
  return vertices;
}

/// Nothing, or what is wrong in a line, and where.
struct Mistake {
  std::string what;
  const char* at = nullptr;
};

const char* skip_blanks(const char* text) {
  while (*text == ' ' || *text == '\t') ++text;
  return text;
}

/// What is wrong with "x y z", if anything.
Mistake vertex_mistake(const char* text) {
  for (int axis = 0; axis < 3; ++axis) {
    text = skip_blanks(text);
    char* after = nullptr;
    const double value = std::strtod(text, &after);
    if (after == text) return {"v needs three numbers", text};
    if (!std::isfinite(value)) return {"v has a number that is not finite", text};
    text = after;
  }
  return {};
}

/// What is wrong with "1 2/1 3//1", if anything; a number below 0 counts back from the last of
/// those so far.
Mistake face_mistake(const char* text, int so_far, int all) {
  for (;;) {
    text = skip_blanks(text);
    if (*text == '\0' || *text == '\r' || *text == '#' || *text == '\\') return {};
    char* after = nullptr;
    const long named = std::strtol(text, &after, 10);
    if (after == text) return {"f holds what is no number of a vertex", text};
    if (named == 0) return {"f names vertex 0, but the first is 1", text};
    if (named > all) return {fmt::format("f names vertex {} of {}", named, all), text};
    if (named < -so_far) return {fmt::format("f names vertex {} after {}", named, so_far), text};
    text = after;
    while (*text != '\0' && *text != ' ' && *text != '\t' && *text != '\r') ++text;
  }
}

}  // namespace

void number_as_in_obj(std::string_view file, Model& model) {
  std::vector<Vec3> all = vertices_of(file);
  const std::size_t in_file = all.size();
  all.insert(all.end(), model.mesh.vertices.begin(), model.mesh.vertices.end());
  sim::Bounds box;
  for (const Vec3& vertex : all) box.include(vertex);
  const double extent = all.empty() ? 0.0 : box.size().maxCoeff();
  if (in_file == 0 || !std::isfinite(extent) || !(extent > 0.0)) return;
  const Weld places = weld(all, same_place * extent);
  std::vector<int> number(places.vertices.size(), 0);  // 0: none of the file's
  for (std::size_t v = in_file; v-- > 0;) {
    number[sim::at(places.new_index[v])] = static_cast<int>(v) + 1;
  }
  std::vector<int> numbers;
  for (std::size_t v = in_file; v < all.size(); ++v) {
    numbers.push_back(number[sim::at(places.new_index[v])]);
    if (numbers.back() == 0) return;
  }
  model.vertices_in_file = static_cast<int>(in_file);
  model.vertex_numbers = std::move(numbers);
}

std::string obj_mistake(std::string_view file) {
  int all = 0, so_far = 0;
  for_each_line(file, [&](char letter, const char*, const Line&) { all += letter == 'v' ? 1 : 0; });
  std::string first;
  for_each_line(file, [&](char letter, const char* text, const Line& line) {
    if (!first.empty()) return;
    so_far += letter == 'v' ? 1 : 0;
    const Mistake mistake = letter == 'v' ? vertex_mistake(text) : face_mistake(text, so_far, all);
    if (mistake.what.empty()) return;
    const auto column = mistake.at - line.text.c_str() + 1;
    first = fmt::format("{}:{}: {}", line.number, column, mistake.what);
  });
  return first;
}

}  // namespace pneuma::assets
