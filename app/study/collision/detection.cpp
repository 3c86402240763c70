#include "app/study/collision/detection.h"

#include <algorithm>
#include <limits>

#include "sim/base/disjoint_sets.h"
#include "sim/collision/feature_contact.h"
#include "sim/collision/find_exact.h"

namespace pneuma::app {
namespace {

using sim::at;
using sim::CloseTriangles;
using sim::Feature;
using sim::FeatureKind;
using sim::MeshTopology;
using sim::SurfaceView;

/// Nearest contacts of the vertices of `own` at triangles close to `other`.
std::vector<ContactTruth::Vertex> close_vertices(const SurfaceView& own, const SurfaceView& other,
                                                 const std::vector<CloseTriangles>& pairs,
                                                 int CloseTriangles::*own_side,
                                                 int CloseTriangles::*other_side, double reach) {
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> distance(at(own.topology.vertex_count()), none);  // below 0: behind
  for (const CloseTriangles& pair : pairs) {
    for (const int v : own.topology.triangles()[at(pair.*own_side)]) {
      const auto found = sim::find_feature_contact(
          own, {FeatureKind::vertex, v}, other, {FeatureKind::triangle, pair.*other_side}, reach);
      if (!found || found->distance >= std::abs(distance[at(v)])) continue;
      const bool behind = (found->first_point - found->second_point).dot(found->normal) < 0.0;
      distance[at(v)] = behind ? -found->distance : found->distance;
    }
  }
  std::vector<ContactTruth::Vertex> vertices;
  for (int v = 0; v < own.topology.vertex_count(); ++v) {
    if (distance[at(v)] < none) vertices.push_back({v, reach - distance[at(v)]});
  }
  return vertices;
}

void unite_neighbours(const MeshTopology& mesh, const std::vector<char>& is_close, int offset,
                      base::DisjointSets& sets) {
  for (const auto& [a, b] : mesh.edge_triangles()) {
    if (is_close[at(offset + a)] && is_close[at(offset + b)]) sets.unite(offset + a, offset + b);
  }
}

void number_regions(const MeshTopology& first, const MeshTopology& second,
                    const std::vector<CloseTriangles>& pairs, ContactTruth& truth) {
  const int count = first.triangle_count();
  base::DisjointSets sets(at(count + second.triangle_count()));
  std::vector<char> is_close(at(count + second.triangle_count()), 0);
  for (const CloseTriangles& pair : pairs) {
    is_close[at(pair.first)] = is_close[at(count + pair.second)] = 1;
    sets.unite(pair.first, count + pair.second);
  }
  unite_neighbours(first, is_close, 0, sets);
  unite_neighbours(second, is_close, count, sets);
  std::vector<int> number(is_close.size(), -1);
  truth.region_of_first.assign(at(count), -1);
  for (int t = 0; t < count; ++t) {
    if (!is_close[at(t)]) continue;
    int& region = number[at(sets.find(t))];
    if (region < 0) region = truth.regions++;
    truth.region_of_first[at(t)] = region;
  }
}

/// The triangles that a feature is, or lies on the border of.
std::span<const int> triangles_at(const MeshTopology& mesh, const Feature& feature) {
  switch (feature.kind) {
    case FeatureKind::vertex:
      return mesh.vertex_triangles(feature.index);
    case FeatureKind::edge:
      return mesh.edge_triangles()[at(feature.index)];
    case FeatureKind::triangle:
      break;
  }
  return {&feature.index, 1};
}

void score_vertices(const std::vector<ContactTruth::Vertex>& vertices,
                    const std::vector<char>& found, DetectionScore& score) {
  for (const auto& [vertex, depth] : vertices) {
    ++score.vertices;
    if (found[at(vertex)]) {
      ++score.vertices_found;
    } else {
      score.greatest_missed = std::max(score.greatest_missed, depth);
    }
  }
}

double share(std::int64_t found, std::int64_t all) {
  return all == 0 ? 1.0 : static_cast<double>(found) / static_cast<double>(all);
}

}  // namespace

double DetectionScore::region_share() const { return share(regions_found, regions); }
double DetectionScore::vertex_share() const { return share(vertices_found, vertices); }

ContactTruth find_truth(const SurfaceView& first, const SurfaceView& second, double reach) {
  const std::vector<CloseTriangles> pairs = sim::find_close_triangles(first, second, reach);
  ContactTruth truth;
  truth.first_vertices =
      close_vertices(first, second, pairs, &CloseTriangles::first, &CloseTriangles::second, reach);
  truth.second_vertices =
      close_vertices(second, first, pairs, &CloseTriangles::second, &CloseTriangles::first, reach);
  number_regions(first.topology, second.topology, pairs, truth);
  return truth;
}

void add_score(const ContactTruth& truth, const MeshTopology& first, const MeshTopology& second,
               std::span<const sim::Contact> contacts, DetectionScore& score) {
  std::vector<char> region_found(at(truth.regions), 0);
  std::vector<char> first_found(at(first.vertex_count()), 0);
  std::vector<char> second_found(at(second.vertex_count()), 0);
  for (const sim::Contact& contact : contacts) {
    for (const int t : triangles_at(first, contact.first.feature)) {
      const int region = truth.region_of_first[at(t)];
      if (region >= 0) region_found[at(region)] = 1;
    }
    for (const int v : first.feature_vertices(contact.first.feature)) first_found[at(v)] = 1;
    for (const int v : second.feature_vertices(contact.second.feature)) second_found[at(v)] = 1;
  }
  score.regions += truth.regions;
  score.regions_found += std::count(region_found.begin(), region_found.end(), 1);
  score_vertices(truth.first_vertices, first_found, score);
  score_vertices(truth.second_vertices, second_found, score);
}

}  // namespace pneuma::app
