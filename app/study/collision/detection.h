// How much of what touches a search for contacts finds, against all pairs of triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/collision/contact.h"
#include "sim/collision/surface_view.h"

namespace pneuma::app {

/// What is within reach between two surfaces.
struct ContactTruth {
  struct Vertex {
    int vertex = 0;
    double depth = 0.0;  // m by which it is within reach: up to the reach outside of the other
                         // surface, more when it is behind it
  };
  std::vector<Vertex> first_vertices;
  std::vector<Vertex> second_vertices;

  // A region is a connected patch of triangles of either body that are within reach of the other.
  // Per triangle of the first body, the region's number, or -1.
  std::vector<int> region_of_first;
  int regions = 0;
};

/// By the exhaustive list of close triangles (sim/collision/find_exact.h). `reach` in m.
ContactTruth find_truth(const sim::SurfaceView& first, const sim::SurfaceView& second,
                        double reach);

/// Sums over steps and pairs of bodies.
struct DetectionScore {
  std::int64_t regions = 0;
  std::int64_t regions_found = 0;  // with at least one contact in them
  std::int64_t vertices = 0;
  std::int64_t vertices_found = 0;  // that are a part of what a contact reports on their body
  double greatest_missed = 0.0;     // m, the max. depth of a vertex that was not found

  double region_share() const;  // 1 when there was nothing to find
  double vertex_share() const;
};

/// Adds what `contacts` of the two bodies, the first of them on side `first`, have found.
void add_score(const ContactTruth& truth, const sim::MeshTopology& first,
               const sim::MeshTopology& second, std::span<const sim::Contact> contacts,
               DetectionScore& score);

}  // namespace pneuma::app
