#include "assets/clean_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string_view>

#include "assets/check_surface.h"
#include "assets/choose_component.h"
#include "assets/part_from_itself.h"
#include "assets/repair_mesh.h"
#include "assets/self_touching.h"
#include "assets/simplify/simplify_mesh.h"
#include "assets/weld.h"
#include "sim/mesh/rotation.h"

namespace pneuma::assets {
namespace {

using sim::at;

// Beyond, squares and cubes of lengths leave the range of numbers.
constexpr double max_extent = 1e30;
constexpr double min_extent = 1e-30;
constexpr std::size_t most_triangles = 100'000'000;  // their corners are numbered by an int
constexpr double min_volume = 1e-9;                  // of the cubed diagonal
constexpr double max_volume_change = 1e-3;           // of a model that is simplified

void check_input(const sim::TriangleMesh& mesh) {
  const auto& [vertices, triangles] = mesh;
  if (triangles.empty()) throw ModelError("the model has no triangles");
  if (std::max(vertices.size(), triangles.size()) > most_triangles) {
    throw ModelError("the model has more than 100 million vertices or triangles; simplify it");
  }
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (vertices[v].allFinite()) continue;
    throw ModelError(fmt::format("vertex {} is not finite: {}", v, coordinates(vertices[v])));
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const int v : triangles[t]) {
      if (v >= 0 && at(v) < vertices.size()) continue;
      throw ModelError(fmt::format("triangle {} uses vertex {}, but there are {} vertices", t, v,
                                   vertices.size()));
    }
  }
}

double diagonal(const sim::TriangleMesh& mesh) {
  sim::Bounds box;
  for (const Vec3& vertex : mesh.vertices) box.include(vertex);
  const double extent = box.size().maxCoeff();
  if (!(extent <= max_extent)) {
    throw ModelError(
        fmt::format("the model is {:.3g} across; the most is {:.0e}", extent, max_extent));
  }
  if (extent < min_extent) {
    throw ModelError(fmt::format("all triangles are in one place, {}",
                                 coordinates(mesh.vertices[at(mesh.triangles[0][0])])));
  }
  return box.size().norm();
}

/// Whether it is more than a layer or several across an axis, as a scale of 0 makes of any model:
/// what that leaves of edges and fans says nothing.
void check_not_flat(const sim::TriangleMesh& mesh, double thickness) {
  sim::Bounds box;
  for (const Vec3& vertex : mesh.vertices) box.include(vertex);
  int axis = 0;
  const double extent = box.size().minCoeff(&axis);
  if (extent > thickness) return;
  constexpr std::string_view names = "xyz";
  throw ModelError(fmt::format(
      "the model is flat: its extent along {0} is {1:.3g}, of {2:.3g} x {3:.3g} x {4:.3g}, so it "
      "has no inside, which gas and contacts need; look at its scale along {0}, or give a sheet "
      "a wall, such as by Blender's Solidify",
      names[at(axis)], extent, box.size().x(), box.size().y(), box.size().z()));
}

/// Between the triangle and the first vertex of all.
double volume_below(const sim::TriangleMesh& mesh, const Triangle& triangle) {
  const Vec3& origin = mesh.vertices.front();
  const Vec3 a = mesh.vertices[at(triangle[0])] - origin;
  const Vec3 b = mesh.vertices[at(triangle[1])] - origin;
  return a.dot(b.cross(mesh.vertices[at(triangle[2])] - origin)) / 6.0;
}

double volume_of(const sim::TriangleMesh& mesh) {
  double volume = 0.0;
  for (const Triangle& triangle : mesh.triangles) volume += volume_below(mesh, triangle);
  return volume;
}

class Cleaner {
 public:
  Cleaner(const Model& model, const CleanOptions& options) : model_(model), options_(options) {}

  CleanModel clean() {
    check_input(model_.mesh);
    number();
    weld_distance_ = weld_tolerance * diagonal(work_.mesh);
    weld_vertices();
    drop_triangles();
    if (options_.repair) repair();
    keep_component();
    make_surface();
    if (options_.simplify_to) simplify(*options_.simplify_to);
    place();
    return std::move(result_);
  }

 private:
  void say(std::string cleaned) { result_.cleaned.push_back(std::move(cleaned)); }

  /// Vertices without triangles go at once: they may lie anywhere, and welding counts from the
  /// first vertex in steps that the triangles' extent gives.
  void number() {
    work_.mesh = model_.mesh;
    work_.vertex_number.resize(work_.mesh.vertices.size());
    work_.triangle_number.resize(work_.mesh.triangles.size());
    std::iota(work_.vertex_number.begin(), work_.vertex_number.end(), 0);
    if (!model_.vertex_numbers.empty()) work_.vertex_number = model_.vertex_numbers;
    std::iota(work_.triangle_number.begin(), work_.triangle_number.end(), 0);
    result_.vertices_before = static_cast<int>(
        model_.vertices_in_file > 0 ? at(model_.vertices_in_file) : work_.mesh.vertices.size());
    lonely_vertices_ = compact();
  }

  void weld_vertices() {
    const Weld welded = weld(work_.mesh.vertices, weld_distance_);
    const std::size_t before = work_.mesh.vertices.size();
    const std::size_t after = welded.vertices.size();
    const std::set<int> in_file(work_.vertex_number.begin(), work_.vertex_number.end());
    std::size_t count = 0;
    for (std::size_t v = 0; v < before; ++v) {
      const bool is_kept = at(welded.new_index[v]) == count;
      if (is_kept) work_.vertex_number[count++] = work_.vertex_number[v];
    }
    work_.vertex_number.resize(after);
    work_.mesh.vertices = welded.vertices;
    for (Triangle& triangle : work_.mesh.triangles) {
      for (int& v : triangle) v = welded.new_index[at(v)];
    }
    result_.vertices_welded = static_cast<int>(after);
    if (after < in_file.size()) {
      say(fmt::format("{} vertices welded to {}", in_file.size(), after));
    }
  }

  /// Those for which `keep` says true, in their order.
  template <class Keep>
  void filter_triangles(const Keep& keep) {
    std::size_t count = 0;
    for (std::size_t t = 0; t < work_.mesh.triangles.size(); ++t) {
      if (!keep(t)) continue;
      work_.mesh.triangles[count] = work_.mesh.triangles[t];
      work_.triangle_number[count] = work_.triangle_number[t];
      ++count;
    }
    work_.mesh.triangles.resize(count);
    work_.triangle_number.resize(count);
  }

  void drop_triangles() {
    const std::size_t all = work_.mesh.triangles.size();
    filter_triangles([&](std::size_t t) {
      const auto& [a, b, c] = work_.mesh.triangles[t];
      return a != b && b != c && c != a;
    });
    const std::size_t proper = work_.mesh.triangles.size();
    if (proper < all) {
      say(counted(all - proper, "degenerate triangle", "degenerate triangles") + " dropped");
    }
    std::set<Triangle> known;
    filter_triangles([&](std::size_t t) {
      Triangle corners = work_.mesh.triangles[t];
      std::sort(corners.begin(), corners.end());
      return known.insert(corners).second;
    });
    const std::size_t single = work_.mesh.triangles.size();
    if (single < proper) {
      say(counted(proper - single, "duplicate triangle", "duplicate triangles") + " dropped");
    }
    if (single == 0) throw ModelError("the model has no triangles that are not degenerate");
    lonely_vertices_ += compact();
    if (lonely_vertices_ > 0) {
      say(counted(at(lonely_vertices_), "vertex", "vertices") + " without triangles dropped");
    }
  }

  void repair() {
    result_.repaired = repair_mesh(work_, weld_distance_);
    if (work_.mesh.triangles.empty()) {
      throw ModelError(fmt::format("no triangle is left after a repair: {}; mend the model",
                                   fmt::join(result_.repaired, "; ")));
    }
    compact();
  }

  /// Numbers the vertices that triangles have without gaps; returns how many others there were.
  int compact() {
    const std::size_t before = work_.mesh.vertices.size();
    std::vector<int> new_index(before, -1);
    for (const Triangle& triangle : work_.mesh.triangles) {
      for (const int v : triangle) new_index[at(v)] = 0;
    }
    int count = 0;
    for (std::size_t v = 0; v < before; ++v) {
      if (new_index[v] < 0) continue;
      new_index[v] = count;
      work_.mesh.vertices[at(count)] = work_.mesh.vertices[v];
      work_.vertex_number[at(count)] = work_.vertex_number[v];
      ++count;
    }
    work_.mesh.vertices.resize(at(count));
    work_.vertex_number.resize(at(count));
    for (Triangle& triangle : work_.mesh.triangles) {
      for (int& v : triangle) v = new_index[at(v)];
    }
    return static_cast<int>(before) - count;
  }

  std::string part_name(std::size_t triangle) const {
    const std::size_t before = at(work_.triangle_number[triangle]);
    if (before >= model_.parts.size()) return {};
    const std::size_t part = at(model_.parts[before]);
    return part < model_.part_names.size() ? model_.part_names[part] : std::string();
  }

  void describe_components(const std::vector<int>& component, const std::vector<Edge>& edges) {
    const auto& [vertices, triangles] = work_.mesh;
    std::vector<Component>& all = result_.components;
    all.resize(at(*std::max_element(component.begin(), component.end())) + 1);
    std::vector<sim::Bounds> boxes(all.size());
    std::vector<char> counted_already(vertices.size(), 0);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const std::size_t number = at(component[t]);
      if (all[number].triangles++ == 0) all[number].name = part_name(t);
      for (const int v : triangles[t]) {
        boxes[number].include(vertices[at(v)]);
        if (!counted_already[at(v)]) ++all[number].vertices;
        counted_already[at(v)] = 1;
      }
    }
    for (const Edge& edge : edges) {
      Component& owner = all[at(component[at(edge.triangles.front())])];
      if (edge.triangles.size() == 1) ++owner.boundary_edges;
      if (edge.triangles.size() > 2) ++owner.non_manifold_edges;
    }
    for (std::size_t i = 0; i < all.size(); ++i) all[i].size = boxes[i].size();
  }

  void keep_component() {
    const std::vector<int> component =
        components_of(work_.mesh.triangles, static_cast<int>(work_.mesh.vertices.size()));
    describe_components(component, edges_of(work_.mesh.triangles));
    result_.kept = choose_component(result_.components, options_.component);
    const std::size_t others = result_.components.size() - 1;
    if (others > 0) {
      filter_triangles([&](std::size_t t) { return component[t] == result_.kept; });
      compact();
      say(fmt::format("{} left out", counted(others, "other component", "other components")));
    }
    check_count();
  }

  /// Of what will be left: that comes to so many or is refused.
  void check_count() const {
    const std::size_t before = work_.mesh.vertices.size();
    const std::size_t after =
        options_.simplify_to ? std::min(before, at(*options_.simplify_to)) : before;
    if (after <= at(options_.most_vertices)) return;
    throw ModelError(fmt::format(
        "{} vertices are more than the limit of {}; simplify the model with model.vertices (of a "
        "model file --vertices N), or raise vertices_per_body in [limits] (--set "
        "limits.vertices_per_body=N)",
        after, options_.most_vertices));
  }

  void make_surface() {
    const std::vector<Edge> edges = edges_of(work_.mesh.triangles);
    check_not_flat(work_.mesh, weld_distance_);
    check_manifold(work_, edges, weld_distance_, options_.repair);
    const Orientation orientation = orient(work_.mesh.triangles, edges);
    if (!orientation.impossible.empty()) {
      throw ModelError(fmt::format(
          "the surface has one side only, like a Klein bottle: {} at which the triangles cannot "
          "agree{}",
          counted(orientation.impossible.size(), "edge", "edges"),
          first_places(orientation.impossible.size(), [&](std::size_t i) {
            return edge_place(work_, orientation.impossible[i]);
          })));
    }
    turn_outwards(orientation);
    if (options_.repair) {
      std::ranges::move(part_from_itself(work_), std::back_inserter(result_.repaired));
    }
    check_self_touching(work_, options_.repair);
  }

  void simplify(int most_vertices) {
    const sim::TriangleMesh full = work_.mesh;
    if (full.vertices.size() <= at(most_vertices)) return;
    work_.mesh = simplify_mesh(full, most_vertices);
    const std::size_t count = work_.mesh.vertices.size();
    if (count > at(most_vertices)) {
      throw SimplifyError(fmt::format(
          "{} vertices cannot be simplified to {}, but to {}; ask for as many (in a scene by "
          "model.vertices)",
          full.vertices.size(), most_vertices, count));
    }
    check_simplified(full);
    result_.simplified = fmt::format("{} vertices simplified to {}", full.vertices.size(), count);
  }

  void check_simplified(const sim::TriangleMesh& full) const {
    const double volume = volume_of(work_.mesh), wanted = volume_of(full);
    const bool is_full = std::abs(volume - wanted) <= max_volume_change * wanted;
    if (is_full && find_self_touching(work_.mesh, 0).count == 0) return;
    throw SimplifyError(fmt::format(
        "{} vertices cannot be simplified to {}: {}; ask for more (in a scene by model.vertices)",
        full.vertices.size(), work_.mesh.vertices.size(),
        is_full ? "the surface would touch itself"
                : fmt::format("the volume would be {:.3g} of {:.3g}", volume, wanted)));
  }

  void turn_outwards(const Orientation& orientation) {
    double volume = 0.0;  // as the first triangle has it
    for (std::size_t t = 0; t < work_.mesh.triangles.size(); ++t) {
      const double part = volume_below(work_.mesh, work_.mesh.triangles[t]);
      volume += orientation.turned[t] ? -part : part;
    }
    const double extent = diagonal(work_.mesh);
    if (!(std::abs(volume) > min_volume * extent * extent * extent)) {
      throw ModelError(fmt::format("the surface holds no volume: {:.3g}, with an extent of {:.3g}",
                                   std::abs(volume), extent));
    }
    std::size_t count = 0;
    for (std::size_t t = 0; t < work_.mesh.triangles.size(); ++t) {
      if ((orientation.turned[t] != 0) == (volume < 0.0)) continue;
      std::swap(work_.mesh.triangles[t][1], work_.mesh.triangles[t][2]);
      ++count;
    }
    if (count > 0)
      say(counted(count, "triangle", "triangles") + " turned, so that all face outwards");
  }

  void place() {
    const double extent = options_.scale * diagonal(work_.mesh);
    if (!(extent >= smallest_model && extent <= largest_model)) {
      throw ModelError(fmt::format(
          "the model is {:.3g} m across; allowed: {:g} m to {:g} m. Give it another scale (in a "
          "scene model.scale), such as {:.3g}",
          extent, smallest_model, largest_model, options_.scale * 2.0 / extent));
    }
    const sim::Mat3 rotation = sim::rotation_of_degrees(options_.rotation).toRotationMatrix();
    const bool turned = options_.rotation != Vec3::Zero();
    sim::Bounds box;
    for (Vec3& vertex : work_.mesh.vertices) {
      vertex *= options_.scale;
      if (turned) vertex = rotation * vertex;
      box.include(vertex);
    }
    if (options_.centre) {
      for (Vec3& vertex : work_.mesh.vertices) vertex -= box.centre();
    } else if (std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff()) >
               largest_model) {
      throw ModelError(fmt::format(
          "the model lies further than {:g} m from its origin; centre it (in a scene with "
          "model.centre = true)",
          largest_model));
    }
    result_.mesh = std::move(work_.mesh);
  }

  const Model& model_;
  const CleanOptions& options_;
  NumberedMesh work_;
  double weld_distance_ = 0.0;
  int lonely_vertices_ = 0;
  CleanModel result_;
};

}  // namespace

CleanModel clean_mesh(const Model& model, const CleanOptions& options) {
  return Cleaner(model, options).clean();
}

}  // namespace pneuma::assets
