#include "sim/collision/find_exact.h"

#include <algorithm>

#include "sim/collision/find_soft_soft.h"

namespace pneuma::sim {
namespace {

Bounds grown(Bounds box, double by) {
  box.low.array() -= by;
  box.high.array() += by;
  return box;
}

Bounds common(const Bounds& a, const Bounds& b) {
  return {a.low.cwiseMax(b.low), a.high.cwiseMin(b.high)};
}

bool is_empty(const Bounds& box) { return !(box.low.array() <= box.high.array()).all(); }

Bounds feature_bounds(const SurfaceView& surface, Feature feature) {
  Bounds box;
  for (const int v : surface.topology.feature_vertices(feature)) box.include(surface.positions[v]);
  return box;
}

/// Where either surface can be within reach of the other.
Bounds common_region(const SurfaceView& first, const SurfaceView& second, double reach) {
  return common(grown(bounds(first.positions), reach), grown(bounds(second.positions), reach));
}

double squared_distance(const Bounds& a, const Bounds& b) {
  return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0).squaredNorm();
}

/// Of a vertex or an edge from a triangle, m, if that is below `reach`.
std::optional<double> distance(const SurfaceView& own, Feature feature, const SurfaceView& other,
                               int triangle, double reach) {
  const Corners corners = triangle_corners(other, triangle);
  const auto near = feature.kind == FeatureKind::vertex
                        ? test_vertex_triangle(own.positions[feature.index], corners, reach)
                        : test_edge_triangle(edge_segment(own, feature.index), corners, reach);
  return near ? std::optional(near->distance) : std::nullopt;
}

/// The contact of a feature with the nearest of the other surface's triangles, if what touches is
/// the feature itself.
std::optional<FeatureContact> nearest_contact(const SurfaceView& own, Feature feature,
                                              const SurfaceView& other, SurfaceGrid& grid,
                                              double reach) {
  int nearest = -1;
  double nearer_than = reach;
  const Bounds box = feature_bounds(own, feature);
  grid.for_each_near(grown(box, reach), [&](int triangle, const Bounds& triangle_box) {
    if (squared_distance(box, triangle_box) >= nearer_than * nearer_than) return;
    if (const auto found = distance(own, feature, other, triangle, nearer_than)) {
      nearer_than = *found;
      nearest = triangle;
    }
  });
  if (nearest < 0) return {};
  auto contact = find_feature_contact(own, feature, other, {FeatureKind::triangle, nearest}, reach);
  if (contact && !(contact->first == feature)) contact.reset();
  return contact;
}

/// Contacts of the vertices and edges of `own`, which are the first of each contact.
void find_from(const SurfaceView& own, const SurfaceView& other, const Bounds& region,
               SurfaceGrid& grid, double reach, std::vector<FeatureContact>& found) {
  grid.fill(other, region);
  const int vertices_and_edges = own.topology.vertex_count() + own.topology.edge_count();
  for (int id = 0; id < vertices_and_edges; ++id) {
    const Feature feature = own.topology.feature(id);
    if (is_empty(common(feature_bounds(own, feature), region))) continue;
    if (auto contact = nearest_contact(own, feature, other, grid, reach)) found.push_back(*contact);
  }
}

/// Of a vertex or an edge, each of which has at most one contact of its own.
int& partner_of(ExactScratch& scratch, const SurfaceView& surface, Feature feature) {
  return scratch.partner[at(surface.topology.feature_id(feature))];
}

/// The same contact seen from the other body. The normal of equal orders is the second's (5.3.1),
/// so it is taken again.
std::optional<FeatureContact> turned_round(const FeatureContact& contact, const SurfaceView& first,
                                           const SurfaceView& second, double reach) {
  return find_feature_contact(first, contact.second, second, contact.first, reach);
}

}  // namespace

void find_exact(const World& world, int first_body, int second_body, ExactScratch& scratch,
                std::vector<Contact>& contacts) {
  const SoftBody& a = world.soft[at(first_body)];
  const SoftBody& b = world.soft[at(second_body)];
  const SurfaceView first{a.mesh->topology, a.positions};
  const SurfaceView second{b.mesh->topology, b.positions};
  const double skin = world.settings.skin_thickness;
  const double reach = 2.0 * skin;
  const Bounds region = common_region(first, second, reach);
  if (is_empty(region)) return;

  scratch.partner.assign(at(first.topology.feature_count()), -1);
  scratch.found.clear();
  find_from(first, second, region, scratch.grid, reach, scratch.found);
  for (const FeatureContact& contact : scratch.found) {
    partner_of(scratch, first, contact.first) = second.topology.feature_id(contact.second);
    contacts.push_back(soft_soft_contact(first_body, second_body, contact, skin));
  }
  scratch.found.clear();
  find_from(second, first, region, scratch.grid, reach, scratch.found);
  for (const FeatureContact& contact : scratch.found) {
    const int own = second.topology.feature_id(contact.first);
    if (partner_of(scratch, first, contact.second) == own) continue;  // found from the other side
    if (const auto mirrored = turned_round(contact, first, second, reach)) {
      contacts.push_back(soft_soft_contact(first_body, second_body, *mirrored, skin));
    }
  }
}

std::vector<CloseTriangles> find_close_triangles(const SurfaceView& first,
                                                 const SurfaceView& second, double reach) {
  std::vector<CloseTriangles> pairs;
  const Bounds region = common_region(first, second, reach);
  if (is_empty(region)) return pairs;
  SurfaceGrid grid;
  grid.fill(second, region);
  for (int t = 0; t < first.topology.triangle_count(); ++t) {
    const Feature feature{FeatureKind::triangle, t};
    const auto start = static_cast<std::ptrdiff_t>(pairs.size());
    grid.for_each_near(grown(feature_bounds(first, feature), reach), [&](int other, const Bounds&) {
      const auto near = test_triangle_triangle(triangle_corners(first, t),
                                               triangle_corners(second, other), reach);
      if (near) pairs.push_back({t, other, near->distance});
    });
    std::sort(pairs.begin() + start, pairs.end(),
              [](const auto& x, const auto& y) { return x.second < y.second; });
  }
  return pairs;
}

}  // namespace pneuma::sim
