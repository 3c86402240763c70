#include "assets/obj_numbers.h"

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

/// The lines "v x y z".
std::vector<Vec3> vertices_of(std::string_view file) {
  std::vector<Vec3> vertices;
  for (std::size_t begin = 0; begin < file.size();) {
    const std::size_t end = std::min(file.find('\n', begin), file.size());
    const std::string line(file.substr(begin, end - begin));
    begin = end + 1;
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == line.npos || line[first] != 'v' || first + 1 == line.size()) continue;
    if (line[first + 1] != ' ' && line[first + 1] != '\t') continue;
    const char* text = line.c_str() + first + 1;
    Vec3 vertex;
    for (int axis = 0; axis < 3; ++axis) {
      char* after = nullptr;
      vertex[axis] = std::strtod(text, &after);
      text = after;
    }
    vertices.push_back(vertex);
  }
  return vertices;
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

}  // namespace pneuma::assets
