// What is around the edges and vertices of triangles that may be no surface at all.
#pragma once

#include <array>
#include <vector>

#include "assets/model.h"

namespace pneuma::assets {

struct Edge {
  std::array<int, 2> vertices;  // lower first
  std::vector<int> triangles;
};

/// Edges of triangles with three different vertices each, sorted by their vertices.
std::vector<Edge> edges_of(const std::vector<Triangle>& triangles);

/// For each triangle the number of its component: what hangs together by vertices. Numbered from 0
/// in the order of the first triangles.
std::vector<int> components_of(const std::vector<Triangle>& triangles, int vertex_count);

/// The vertices at which more than one fan of triangles meets, where no edge has more than two
/// triangles.
std::vector<int> vertices_of_several_fans(const std::vector<Triangle>& triangles,
                                          const std::vector<Edge>& edges, int vertex_count);

struct Orientation {
  std::vector<char> turned;      // per triangle
  std::vector<Edge> impossible;  // edges at which no turning helps: the surface has one side only
};

/// Which triangles to turn so that the two at each edge agree, the first triangle of each piece
/// left as it is. `edges` have two triangles each.
Orientation orient(const std::vector<Triangle>& triangles, const std::vector<Edge>& edges);

}  // namespace pneuma::assets
