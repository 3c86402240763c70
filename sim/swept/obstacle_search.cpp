#include "sim/swept/obstacle_search.h"

#include <algorithm>
#include <cmath>

namespace pneuma::sim {
namespace {

/// Whether ways to two sides lead to one side of the plane across a direction.
bool are_on_one_side(Vec4d one, Vec4d other, Vec4d direction) {
  const double along_one = dot(direction, one), along_other = dot(direction, other);
  if (along_one * along_other >= 0.0) return true;
  const double least = sine_of_one_face * sine_of_one_face * dot(direction, direction);
  return along_one * along_one <= least * dot(one, one) ||
         along_other * along_other <= least * dot(other, other);
}

}  // namespace

/// Goes down both trees.
class ObstacleSearch::TriangleSearch {
 public:
  TriangleSearch(const BesideObstacle& pair, const WayBoxes& boxes, std::vector<TrianglePair>& near)
      : pair_(pair),
        boxes_(boxes),
        soft_(*pair.soft.tree),
        obstacle_(*pair.obstacle.tree),
        start_(pair.soft.start),
        end_(pair.soft.end),
        near_(near) {}

  void descend(int i, int j) {
    const WayBox &one = boxes_.nodes[at(i)], &other = pair_.obstacle.nodes[at(j)];
    if (!overlap(one, other) || is_above_plane(one, j)) return;
    const SurfaceTree::Node &a = soft_.nodes()[at(i)], &b = obstacle_.nodes()[at(j)];
    if (a.is_leaf()) {
      for (int s = a.first; s < a.end; ++s) meet_below(soft_.order()[at(s)], j);
    } else if (b.is_leaf() || squared_size(one) >= squared_size(other)) {
      descend(i + 1, j);
      descend(soft_.nodes()[at(i + 1)].next, j);
    } else {
      descend(i, j + 1);
      descend(i, obstacle_.nodes()[at(j + 1)].next);
    }
  }

 private:
  static double squared_size(const WayBox& box) {
    return dot(box.high - box.low, box.high - box.low);
  }

  /// What of the obstacle is below a node.
  void meet_below(int triangle, int node) {
    const WayBox& box = boxes_.triangles[at(triangle)];
    const Triangle& corners = soft_.topology().triangles()[at(triangle)];
    const Vec3x4 from = corner_columns(start_, corners), to = corner_columns(end_, corners);
    const auto& nodes = obstacle_.nodes();
    for (const int end = nodes[at(node)].next; node < end;) {
      if (!overlap(box, pair_.obstacle.nodes[at(node)]) || is_above_plane(from, to, node)) {
        node = nodes[at(node)].next;
        continue;
      }
      for (int t = nodes[at(node)].first; t < nodes[at(node)].end; ++t) {
        const int other = obstacle_.order()[at(t)];
        if (overlap(box, pair_.obstacle.triangles[at(other)])) near_.push_back({triangle, other});
      }
      ++node;
    }
  }

  /// A box that is wide enough.
  bool is_above_plane(const WayBox& box, int node) const {
    const ObstacleShape::Plane& plane = pair_.shape.planes()[at(node)];
    const Vec4d lowest = min(plane.normal * box.low, plane.normal * box.high);
    return lowest[0] + lowest[1] + lowest[2] > plane.height;
  }
  bool is_above_plane(const Vec3x4& from, const Vec3x4& to, int node) const {
    const ObstacleShape::Plane& plane = pair_.shape.planes()[at(node)];
    const double least = plane.height + pair_.near;
    return all_of_lanes(dots(plane.normal, from) >= least) &&
           all_of_lanes(dots(plane.normal, to) >= least + pair_.allowance);
  }

  const BesideObstacle& pair_;
  const WayBoxes& boxes_;  // of the soft body
  const SurfaceTree& soft_;
  const SurfaceTree& obstacle_;
  const VertexReader start_, end_;  // of the soft body
  std::vector<TrianglePair>& near_;
};

/// Of near triangles, the features that matter.
class ObstacleSearch::FeatureSearch {
 public:
  FeatureSearch(const BesideObstacle& pair, bool may_pass, ObstacleSearch& search,
                std::vector<NearFeatures>& pairs)
      : pair_(pair),
        may_pass_(may_pass),
        reach_(may_pass ? pair.least : pair.near),
        soft_(*pair.soft.tree),
        obstacle_(*pair.obstacle.tree),
        start_(pair.soft.start),
        end_(pair.soft.end),
        search_(search),
        pairs_(pairs) {}

  void meet(int triangle, int other) {
    const SoftTriangle& soft = soft_triangle(triangle);
    const WayBox& box = pair_.obstacle.triangles[at(other)];
    if (!overlap(soft.box, box)) return;
    const Triangle& corners = obstacle_.topology().triangles()[at(other)];
    const Face& face = pair_.shape.faces()[at(other)];
    const double beyond = clearance_beyond(soft, face);
    if (beyond >= pair_.near) return;
    const Vec4d heights = heights_above(soft, face.corners);
    const double lowest = smallest_lane(heights);
    if (lowest >= pair_.near) return;
    for (const int v : soft_.owned_by(triangle).vertices()) {
      if (!overlap(vertex_box(v), box)) continue;
      add({FeatureKind::vertex, v}, {FeatureKind::triangle, other});
    }
    if (std::max(lowest, beyond) >= reach_) return;
    for (std::size_t i = 0; i < 3; ++i) {
      const int v = corners[i];
      const double height = heights[static_cast<int>(i)];
      if (height >= reach_ || obstacle_.owner_of_vertex(v) != other) continue;
      if (!pair_.shape.is_touchable_vertex(v)) continue;
      if (!overlap(soft.box, pair_.obstacle.vertices[at(v)])) continue;
      add({FeatureKind::triangle, triangle}, {FeatureKind::vertex, v});
    }
    meet_edges(triangle, soft.box, other);
  }

 private:
  using Face = ObstacleShape::Face;
  using EdgeSides = ObstacleShape::EdgeSides;

  void meet_edges(int triangle, const WayBox& box, int other) {
    for (const int f : obstacle_.owned_by(other).edges()) {
      if (!pair_.shape.is_touchable_edge(f)) continue;
      const WayBox around = edge_box(obstacle_, pair_.obstacle, f);
      if (!overlap(box, around)) continue;
      const EdgeSides& sides = pair_.shape.edge_sides()[at(f)];
      for (const int e : soft_.owned_by(triangle).edges()) {
        const SoftEdge& soft = soft_edge(e);
        if (!overlap(soft.box, around)) continue;
        if (!may_pass_ && !may_be_nearest(soft.sides, sides)) continue;
        add({FeatureKind::edge, e}, {FeatureKind::edge, f});
      }
    }
  }

  /// At the start, as far as their directions tell.
  static bool may_be_nearest(const EdgeSides& one, const EdgeSides& other) {
    const Vec4d apart = cross(one.along, other.along);
    return are_on_one_side(one.into_first, one.into_second, apart) &&
           are_on_one_side(other.into_first, other.into_second, apart);
  }

  void add(const Feature& of_soft, const Feature& of_obstacle) {
    pairs_.push_back(pair_.soft_is_first ? NearFeatures{of_soft, of_obstacle}
                                         : NearFeatures{of_obstacle, of_soft});
  }

  WayBox vertex_box(int vertex) const {
    const Vec4d from = start_[vertex], to = end_[vertex];
    return {min(from, to) - pair_.near, max(from, to) + pair_.near};
  }

  const SoftEdge& soft_edge(int edge) {
    SoftEdge& soft = search_.edges_[at(edge)];
    if (search_.edge_known_in_[at(edge)] == search_.search_) return soft;
    search_.edge_known_in_[at(edge)] = search_.search_;
    const auto& [from, to] = soft_.topology().edges()[at(edge)];
    soft.sides = edge_sides_of(soft_.topology(), start_, edge);
    soft.box = vertex_box(from);
    soft.box.include(vertex_box(to));
    return soft;
  }

  const SoftTriangle& soft_triangle(int triangle) {
    SoftTriangle& soft = search_.triangles_[at(triangle)];
    if (search_.known_in_[at(triangle)] == search_.search_) return soft;
    search_.known_in_[at(triangle)] = search_.search_;
    const Triangle& corners = soft_.topology().triangles()[at(triangle)];
    soft.box = WayBox{};
    for (const int v : corners) soft.box.include(vertex_box(v));
    soft.normal_at_start = unit_normal(start_, corners);
    soft.normal_at_end = unit_normal(end_, corners);
    soft.corners_at_start = corner_columns(start_, corners);
    soft.corners_at_end = corner_columns(end_, corners);
    // Bernstein's coefficients of n(t) . x(t), both linear in time.
    const Vec3x4 &from = soft.corners_at_start, &to = soft.corners_at_end;
    soft.at_start = greatest_lane(dots(soft.normal_at_start, from));
    soft.between =
        greatest_lane(0.5 * (dots(soft.normal_at_start, to) + dots(soft.normal_at_end, from)));
    soft.at_end = greatest_lane(dots(soft.normal_at_end, to));
    return soft;
  }

  /// m, by which the corners of the obstacle's triangle stay above the plane at least.
  static Vec4d heights_above(const SoftTriangle& soft, const Vec3x4& corners) {
    const Vec4d first = dots(soft.normal_at_start, corners);
    const Vec4d last = dots(soft.normal_at_end, corners);
    const Vec4d middle = 0.5 * (first + last);
    return min(min(first - soft.at_start, last - soft.at_end), middle - soft.between);
  }

  /// m, by which the triangle of the soft body stays above the plane of the other at least. Of one
  /// without area, nothing is known.
  static double clearance_beyond(const SoftTriangle& soft, const Face& face) {
    const Vec4d first = dots(face.plane.normal, soft.corners_at_start) - face.plane.height;
    const Vec4d last = dots(face.plane.normal, soft.corners_at_end);
    return smallest_lane(min(first, last - face.top));
  }

  const BesideObstacle& pair_;
  const bool may_pass_;  // on their ways, rather than be nearest at the start
  const double reach_;   // m, of all but vertices of the soft body
  const SurfaceTree& soft_;
  const SurfaceTree& obstacle_;
  const VertexReader start_, end_;  // of the soft body
  ObstacleSearch& search_;
  std::vector<NearFeatures>& pairs_;
};

void ObstacleSearch::find_near_triangles(const BesideObstacle& pair,
                                         std::vector<TrianglePair>& near) {
  near.clear();
  fit(pair.soft, pair.near + pair.allowance, boxes_);
  TriangleSearch(pair, boxes_, near).descend(0, 0);
}

void ObstacleSearch::find_nearest_at_start(const BesideObstacle& pair,
                                           std::span<const TrianglePair> near,
                                           std::vector<NearFeatures>& pairs) {
  find(pair, false, near, pairs);
}

void ObstacleSearch::find_first_to_pass(const BesideObstacle& pair,
                                        std::span<const TrianglePair> near,
                                        std::vector<NearFeatures>& pairs) {
  find(pair, true, near, pairs);
}

void ObstacleSearch::find(const BesideObstacle& pair, bool may_pass,
                          std::span<const TrianglePair> near, std::vector<NearFeatures>& pairs) {
  const MeshTopology& topology = pair.soft.tree->topology();
  triangles_.resize(std::max(triangles_.size(), at(topology.triangle_count())));
  known_in_.resize(triangles_.size());
  edges_.resize(std::max(edges_.size(), at(topology.edge_count())));
  edge_known_in_.resize(edges_.size());
  ++search_;
  FeatureSearch search(pair, may_pass, *this, pairs);
  for (const auto& [triangle, other] : near) search.meet(triangle, other);
}

}  // namespace pneuma::sim
