#include "assets/check_surface.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "assets/fill_holes.h"
#include "assets/self_touching.h"

namespace pneuma::assets {
namespace {

using sim::at;

const std::string with_repair = "--repair (in a scene model.repair = true)";

std::string edges_fault(const NumberedMesh& mesh, const std::vector<const Edge*>& faulty,
                        std::string_view what) {
  return fmt::format("{}{}", what, first_places(faulty.size(), [&](std::size_t i) {
                       return edge_place(mesh, *faulty[i]);
                     }));
}

template <class Predicate>
std::vector<const Edge*> those(const std::vector<Edge>& edges, const Predicate& predicate) {
  std::vector<const Edge*> result;
  for (const Edge& edge : edges) {
    if (predicate(edge)) result.push_back(&edge);
  }
  return result;
}

/// The height above the longest side.
double height(const sim::TriangleMesh& mesh, const Triangle& triangle) {
  const Vec3& a = mesh.vertices[at(triangle[0])];
  const Vec3& b = mesh.vertices[at(triangle[1])];
  const Vec3& c = mesh.vertices[at(triangle[2])];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return (b - a).cross(c - a).norm() / longest;
}

std::vector<int> flat_triangles(const sim::TriangleMesh& mesh, double min_height) {
  std::vector<int> result;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!(height(mesh, mesh.triangles[t]) > min_height)) result.push_back(static_cast<int>(t));
  }
  return result;
}

}  // namespace

void check_manifold(const NumberedMesh& mesh, const std::vector<Edge>& edges, double min_height,
                    bool was_repaired) {
  std::vector<std::string> faults;
  const auto open = those(edges, [](const Edge& edge) { return edge.triangles.size() == 1; });
  if (!open.empty()) {
    faults.push_back(edges_fault(
        mesh, open,
        fmt::format("the surface is open, so it has no inside, which gas and contacts need (also "
                    "those of an obstacle): {} with one triangle only",
                    counted(open.size(), "boundary edge", "boundary edges"))));
  }
  const auto crowded = those(edges, [](const Edge& edge) { return edge.triangles.size() > 2; });
  if (!crowded.empty()) {
    faults.push_back(
        edges_fault(mesh, crowded,
                    fmt::format("the surface is not manifold: {} with three triangles or more",
                                counted(crowded.size(), "edge", "edges"))));
  }
  const auto pinched = vertices_of_several_fans(mesh.mesh.triangles, edges,
                                                static_cast<int>(mesh.mesh.vertices.size()));
  if (!pinched.empty()) {
    faults.push_back(
        fmt::format("the surface is not manifold: {} at which several fans of triangles meet{}",
                    counted(pinched.size(), "vertex", "vertices"),
                    first_places(pinched.size(),
                                 [&](std::size_t i) { return vertex_place(mesh, pinched[i]); })));
  }
  const auto flat = flat_triangles(mesh.mesh, min_height);
  if (!flat.empty()) {
    faults.push_back(fmt::format(
        "{} without area, lower than {:.2g}{}", counted(flat.size(), "triangle", "triangles"),
        min_height,
        first_places(flat.size(), [&](std::size_t i) { return triangle_place(mesh, flat[i]); })));
  }
  if (was_repaired && !open.empty() && crowded.empty() && pinched.empty()) {
    faults.push_back(why_holes_are_left(edges));
  }
  if (faults.empty()) return;
  faults.push_back(
      std::string(was_repaired ? "no repair is known for this; mend"
                               : with_repair + " mends what is small; else mend") +
      " it in a modelling program: close holes, take away inner and doubled faces, merge needles" +
      (open.empty() ? "" : "; give a sheet or an open bowl a wall, such as by Blender's Solidify"));
  throw ModelError(fmt::format("{}", fmt::join(faults, "\n  ")));
}

void check_self_touching(const NumberedMesh& mesh, bool was_repaired) {
  const SelfTouching touching = find_self_touching(mesh.mesh, most_places);
  if (touching.count > 0) {
    throw ModelError(fmt::format(
        "the surface touches itself: {}{} of triangles meet{}; part them, {}or cut the model there",
        touching.complete ? "" : "at least ", counted(touching.count, "pair", "pairs"),
        first_places(touching.first.size(),
                     [&](std::size_t i) {
                       return fmt::format("{} and {}", triangle_place(mesh, touching.first[i][0]),
                                          triangle_place(mesh, touching.first[i][1]));
                     }),
        was_repaired ? "" : "try " + with_repair + ", "));
  }
  if (!touching.complete) {
    throw ModelError(
        "too many triangles lie over each other to look for those that touch; mesh the model more "
        "evenly");
  }
}

}  // namespace pneuma::assets
