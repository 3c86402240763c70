#include "sim/potential/near_pairs.h"

#include <algorithm>

#include "sim/potential/mollifier.h"
#include "sim/potential/pair_distance.h"

namespace pneuma::sim {
namespace {

/// What a pair's vertices and weight are, from the features of two surfaces.
ContactPair make_pair(const ContactSurface& a, const ContactSurface& b, const NearFeatures& near) {
  if (near.second.kind == FeatureKind::vertex) {
    return make_pair(b, a, {near.second, near.first});
  }
  ContactPair pair;
  const MeshTopology &of_a = a.topology(), &of_b = b.topology();
  if (near.first.kind == FeatureKind::vertex) {
    const Triangle& t = of_b.triangles()[at(near.second.index)];
    pair.vertices = {a.first_vertex + near.first.index, b.first_vertex + t[0],
                     b.first_vertex + t[1], b.first_vertex + t[2]};
    pair.weight =
        vertex_weight(a.areas[at(near.first.index)], b.triangle_areas[at(near.second.index)]);
    return pair;
  }
  const auto& one = of_a.edges()[at(near.first.index)];
  const auto& other = of_b.edges()[at(near.second.index)];
  pair.is_edges = true;
  pair.vertices = {a.first_vertex + one[0], a.first_vertex + one[1], b.first_vertex + other[0],
                   b.first_vertex + other[1]};
  const double length = a.edge_lengths[at(near.first.index)];
  const double other_length = b.edge_lengths[at(near.second.index)];
  pair.weight = edge_weight(length, other_length);
  pair.mollifier = mollifier_threshold(length, other_length);
  if (pair.vertices[2] < pair.vertices[0] ||
      (pair.vertices[2] == pair.vertices[0] && pair.vertices[3] < pair.vertices[1])) {
    std::swap(pair.vertices[0], pair.vertices[2]);
    std::swap(pair.vertices[1], pair.vertices[3]);
  }
  return pair;
}

bool comes_before(const ContactPair& a, const ContactPair& b) {
  if (a.vertices != b.vertices) return a.vertices < b.vertices;
  return a.is_edges < b.is_edges;
}

void take_positions(const ContactSurface& surface, const VertexArray& all, VertexArray& own) {
  own.rows() = all.rows().middleCols(surface.first_vertex, surface.vertex_count);
}

}  // namespace

PairFinder::PairFinder(const ContactSurfaces& surfaces) : surfaces_(surfaces) {
  for (const ContactSurface& surface : surfaces.all()) {
    MovingSurface& moving = moving_.emplace_back();
    moving.tree = surface.tree;
    moving.start = moving.end = VertexArray(surface.vertex_count);
  }
}

void PairFinder::find(const VertexArray& from, const VertexArray& to, double margin,
                      std::vector<ContactPair>& pairs) {
  pairs.clear();
  for (int i = 0; i < surfaces_.count(); ++i) {
    take_positions(surfaces_[i], from, moving_[at(i)].start);
    take_positions(surfaces_[i], to, moving_[at(i)].end);
    refit(moving_[at(i)], 0.5 * surfaces_[i].reach + margin);
  }
  for (int i = 0; i < surfaces_.count(); ++i) {
    for (int j = i; j < surfaces_.count(); ++j) {
      if (i == j && surfaces_[i].is_rigid) continue;
      if (surfaces_[i].is_mobile || surfaces_[j].is_mobile) add(i, j, pairs);
    }
  }
  std::sort(pairs.begin(), pairs.end(), comes_before);
}

void PairFinder::add(int first, int second, std::vector<ContactPair>& pairs) {
  near_.clear();
  if (first == second) {
    find_near_features(moving_[at(first)], near_);
  } else {
    find_near_features(moving_[at(first)], moving_[at(second)], near_);
  }
  if (near_.empty()) return;
  const ContactSurface &a = surfaces_[first], &b = surfaces_[second];
  const ContactMaterial material = combine(a.material, b.material);
  for (const NearFeatures& near : near_) {
    ContactPair pair = make_pair(a, b, near);
    if (std::ranges::none_of(pair.vertices, [&](int v) { return surfaces_.is_mobile(v); })) {
      continue;
    }
    pair.first = first;
    pair.second = second;
    pair.reach = first == second ? a.self_reach : std::min(a.reach, b.reach);
    pair.restitution = material.restitution;
    pair.friction = material.friction;
    pairs.push_back(pair);
  }
}

double vertex_weight(double vertex_area, double triangle_area) {
  // A vertex of a far coarser surface stands for no more than what it meets.
  return 0.5 * std::min(vertex_area, 2.0 * triangle_area);
}

// Lines of L1 and L2 m per m^2 in random directions cross 2 / pi L1 L2 times per m^2; equilateral
// meshes have sqrt(12) / l.
double edge_weight(double first_length, double second_length) {
  constexpr double per_square_length = 1.0 / 12.0;
  return per_square_length * first_length * second_length;
}

double min_self_distance(const ContactSurface& surface, const VertexArray& positions,
                         double within) {
  MovingSurface moving;
  moving.tree = surface.tree;
  moving.start = moving.end = positions;
  refit(moving, 0.5 * within);
  std::vector<NearFeatures> near;
  find_near_features(moving, near);
  ContactSurface alone = surface;
  alone.first_vertex = 0;
  double least = within;
  for (const NearFeatures& features : near) {
    const ContactPair pair = make_pair(alone, alone, features);
    PairCorners x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = positions[pair.vertices[i]];
    const PairPoint point = pair.is_edges ? nearest_edge_edge(x) : nearest_vertex_triangle(x);
    least = std::min(least, point.distance);
  }
  return least;
}

}  // namespace pneuma::sim
