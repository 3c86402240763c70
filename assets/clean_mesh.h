// From the triangles of a file to one closed surface that can hold gas.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "assets/model.h"
#include "sim/mesh/measure.h"

namespace pneuma::assets {

struct CleanOptions {
  // Which component to keep, by its name or its number counted from 1. Empty: the only closed one.
  std::string component = {};
  double scale = 1.0;            // metres per unit of the file, > 0
  Vec3 rotation = Vec3::Zero();  // degrees about x, then y, then z, after scaling
  bool centre = true;            // the middle of the turned bounding box comes to the origin
  bool repair = false;           // also mends what needs a guess: repair_mesh.h, part_from_itself.h
  std::optional<int> simplify_to = {};  // vertices at most, of what is repaired; none: all
  int most_vertices = 100'000;          // of the component, once it is welded and simplified
};

/// A model that cannot be as coarse as is asked for.
struct SimplifyError : ModelError {
  using ModelError::ModelError;
};

/// What hangs together by vertices, after welding.
struct Component {
  std::string name;  // of the object that its first triangle belongs to; may be empty
  int vertices = 0;
  int triangles = 0;
  int boundary_edges = 0;      // with one triangle
  int non_manifold_edges = 0;  // with three and more
  Vec3 size = Vec3::Zero();    // of its bounding box, in the file's units

  bool closed() const { return boundary_edges == 0 && non_manifold_edges == 0; }
};

struct CleanModel {
  sim::TriangleMesh mesh;             // m; closed, manifold, outwards: fit for sim::make_soft_mesh
  std::vector<std::string> cleaned;   // in plain words: "24 vertices welded to 8"
  std::vector<std::string> repaired;  // likewise, what CleanOptions::repair did, and where
  std::string simplified;             // likewise, what CleanOptions::simplify_to did; may be empty
  std::vector<Component> components;
  int kept = 0;             // index into components
  int vertices_before = 0;  // of the whole file
  int vertices_welded = 0;  // of all triangles of the file, after welding
};

/// Max. and min. diagonal of a scaled model's bounding box, in metres: what scenes can show.
inline constexpr double largest_model = 1e6;
inline constexpr double smallest_model = 1e-6;

/// Repairs what needs no guess: drops vertices without triangles, welds vertices
/// (weld.h), drops triangles with a vertex twice and triangles that are there twice, leaves out all
/// but one component, turns triangles so that all face outwards; with `repair` also what needs one.
/// With `simplify_to`, simplify_mesh.h. Then scales, turns and centres.
///
/// Throws SimplifyError when the surface cannot have so few vertices.
/// Throws ModelError for all else, with counts, up to five places and what to do: no triangles,
/// indices out of range, coordinates that are not finite, too large or too small, too many
/// vertices, several closed components, a surface that is open, not manifold at an edge or a
/// vertex, flat, one-sided, or touches itself, triangles without area (lower than the distance of
/// welding), no volume (1e-9 of the cubed diagonal or less). Places are given by the numbers and
/// coordinates of the input.
CleanModel clean_mesh(const Model& model, const CleanOptions& options = {});

}  // namespace pneuma::assets
