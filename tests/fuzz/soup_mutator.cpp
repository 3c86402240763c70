// How libFuzzer changes triangle soups. Bytes changed at random make hardly ever a closed surface;
// half of the changes here keep one closed, or nearly.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>

#include "tests/fuzz/triangle_soup.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed);

namespace pneuma::fuzz {
namespace {

class Mutator {
 public:
  Mutator(TriangleSoup& soup, unsigned seed) : soup_(soup), random_(seed) {}

  void change() {
    constexpr std::array<void (Mutator::*)(), 9> changes = {
        &Mutator::move_vertex,   &Mutator::split_triangle,  &Mutator::flip_edge,
        &Mutator::double_vertex, &Mutator::merge_vertices,  &Mutator::turn_triangle,
        &Mutator::drop_triangle, &Mutator::double_triangle, &Mutator::change_options};
    if (soup_.vertices.empty() || soup_.triangles.empty()) return;
    (this->*changes[below(changes.size())])();
  }

 private:
  std::size_t below(std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_);
  }
  Byte any_byte() { return static_cast<Byte>(below(256)); }
  std::array<Byte, 6>& any_vertex() { return soup_.vertices[below(soup_.vertices.size())]; }
  std::array<Byte, 3>& any_triangle() { return soup_.triangles[below(soup_.triangles.size())]; }
  bool full() const { return soup_.vertices.size() >= most_soup_vertices; }
  Byte add_vertex(const std::array<Byte, 6>& vertex) {
    soup_.vertices.push_back(vertex);
    return static_cast<Byte>(soup_.vertices.size() - 1);
  }

  void move_vertex() { any_vertex()[below(6)] = any_byte(); }
  void change_options() { soup_.options = any_byte(); }
  void turn_triangle() { std::swap(any_triangle()[0], any_triangle()[1]); }
  void double_triangle() { soup_.triangles.push_back(any_triangle()); }
  void drop_triangle() {
    soup_.triangles.erase(soup_.triangles.begin() +
                          static_cast<std::ptrdiff_t>(below(soup_.triangles.size())));
  }

  /// Into three, about a vertex near the first corner.
  void split_triangle() {
    if (full()) return;
    std::array<Byte, 3>& triangle = any_triangle();
    const auto [a, b, c] = triangle;
    if (a >= soup_.vertices.size()) return;
    const Byte middle = add_vertex(soup_.vertices[a]);
    any_coordinate(soup_.vertices.back()) += static_cast<Byte>(below(5)) - 2;
    triangle = {a, b, middle};
    soup_.triangles.push_back({b, c, middle});
    soup_.triangles.push_back({c, a, middle});
  }

  Byte& any_coordinate(std::array<Byte, 6>& vertex) { return vertex[2 * below(3)]; }

  /// The other diagonal of the two triangles at an edge.
  void flip_edge() {
    std::array<Byte, 3>& one = any_triangle();
    for (std::array<Byte, 3>& other : soup_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (other[(i + 1) % 3] != one[0] || other[i] != one[1]) continue;
        const Byte a = one[0], b = one[1], c = one[2], d = other[(i + 2) % 3];
        one = {c, a, d};
        other = {d, b, c};
        return;
      }
    }
  }

  /// As importers do it at seams: one corner gets a vertex of its own in the same place.
  void double_vertex() {
    if (full()) return;
    Byte& corner = any_triangle()[below(3)];
    if (corner < soup_.vertices.size()) corner = add_vertex(soup_.vertices[corner]);
  }

  void merge_vertices() {
    const std::array<Byte, 3> triangle = any_triangle();
    for (std::array<Byte, 3>& other : soup_.triangles) {
      std::replace(other.begin(), other.end(), triangle[0], triangle[1]);
    }
  }

  TriangleSoup& soup_;
  std::minstd_rand random_;
};

}  // namespace
}  // namespace pneuma::fuzz

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned seed) {
  if (seed % 2 == 0) return LLVMFuzzerMutate(data, size, most);
  pneuma::fuzz::TriangleSoup soup = pneuma::fuzz::decode({reinterpret_cast<char*>(data), size});
  pneuma::fuzz::Mutator(soup, seed).change();
  const std::string bytes = pneuma::fuzz::encode(soup).substr(0, most);
  std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}
