#include "sim/inspect/crossings.h"

#include <algorithm>

#include "sim/inspect/triangle_tree.h"

namespace pneuma::sim {
namespace {

/// One surface and what finds its triangles.
struct Searchable {
  explicit Searchable(ClosedSurface closed) : surface(std::move(closed)), tree(surface) {}

  ClosedSurface surface;
  TriangleTree tree;
};

bool has_vertex(const Triangle& triangle, int vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

bool share_vertex(const std::array<int, 2>& edge, const Triangle& triangle) {
  return has_vertex(triangle, edge[0]) || has_vertex(triangle, edge[1]);
}

/// Where a segment meets a surface on a side or a corner of triangles, all triangles there must be
/// asked before it is known whether it passes through or only touches: their directions sum up to
/// 1, -1 or 0. A segment that lies in the plane of one of them runs along the surface there, and
/// touches it.
class SideMeetings {
 public:
  void add(const Triangle& triangle, const base::Passage& passage) {
    const std::array<int, 2> place = met_feature(triangle, passage.meets_side);
    for (Meeting& meeting : meetings_) {
      if (meeting.place != place) continue;
      meeting.directions += passage.direction;
      return;
    }
    meetings_.push_back({place, passage.direction});
  }

  void add_in_plane(const Triangle& triangle) { in_plane_.push_back(triangle); }

  bool pass() const {
    return std::any_of(meetings_.begin(), meetings_.end(), [&](const Meeting& meeting) {
      return meeting.directions != 0 && !is_in_plane_at(meeting.place);
    });
  }

  void clear() {
    meetings_.clear();
    in_plane_.clear();
  }

 private:
  struct Meeting {
    std::array<int, 2> place;  // the ends of an edge, or one vertex twice
    int directions;
  };

  /// The side that is met, or of two sides the corner between them.
  static std::array<int, 2> met_feature(const Triangle& triangle,
                                        const std::array<bool, 3>& meets_side) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int corner = triangle[(i + 1) % 3];
      if (meets_side[i] && meets_side[(i + 1) % 3]) return {corner, corner};
    }
    const std::size_t side = meets_side[0] ? 0 : meets_side[1] ? 1 : 2;
    const auto [low, high] = std::minmax(triangle[side], triangle[(side + 1) % 3]);
    return {low, high};
  }

  bool is_in_plane_at(const std::array<int, 2>& place) const {
    return std::any_of(in_plane_.begin(), in_plane_.end(), [&](const Triangle& triangle) {
      return has_vertex(triangle, place[0]) && has_vertex(triangle, place[1]);
    });
  }

  std::vector<Meeting> meetings_;
  std::vector<Triangle> in_plane_;  // triangles in whose plane the segment lies
};

/// Whether an edge passes through a surface; `own`: it is an edge of that surface.
bool passes_through(const Searchable& other, const std::array<int, 2>& edge, const base::Point& p,
                    const base::Point& q, bool own, SideMeetings& side_meetings) {
  Extent extent;
  extent.include(p);
  extent.include(q);
  if (!extent.meets(other.tree.extent())) return false;
  bool passes = false;
  side_meetings.clear();
  other.tree.for_each_near(extent, [&](int t) {
    const Triangle& triangle = other.surface.triangles[at(t)];
    if (passes || (own && share_vertex(edge, triangle))) return;
    const auto& points = other.surface.points;
    const base::Passage passage = base::find_passage(
        p, q, points[at(triangle[0])], points[at(triangle[1])], points[at(triangle[2])]);
    if (passage.in_plane) side_meetings.add_in_plane(triangle);
    if (passage.direction == 0) return;
    const auto& meets = passage.meets_side;
    if (meets[0] || meets[1] || meets[2]) {
      side_meetings.add(triangle, passage);
    } else {
      passes = true;
    }
  });
  return passes || side_meetings.pass();
}

int count_edges_through(const Searchable& first, const Searchable& other, bool own) {
  SideMeetings side_meetings;
  int count = 0;
  for (const auto& edge : first.surface.edges) {
    const base::Point& p = first.surface.points[at(edge[0])];
    const base::Point& q = first.surface.points[at(edge[1])];
    if (passes_through(other, edge, p, q, own, side_meetings)) ++count;
  }
  return count;
}

}  // namespace

Crossings crossings(const World& world) {
  Crossings all = crossings(closed_surfaces(world), static_cast<int>(world.soft.size()));
  std::erase_if(all.pairs, [&](const CrossingPair& pair) {
    if (!is_kinematic(world, pair.first) || !is_kinematic(world, pair.second)) return false;
    all.between_bodies -= pair.edges;
    return true;
  });
  return all;
}

Crossings crossings(std::vector<ClosedSurface> surfaces, int soft) {
  std::vector<Searchable> bodies;
  for (ClosedSurface& surface : surfaces) bodies.emplace_back(std::move(surface));
  const int count = static_cast<int>(bodies.size());

  Crossings result;
  for (int i = 0; i < count; ++i) {
    const Searchable& first = bodies[at(i)];
    if (i < soft) {
      const int edges = count_edges_through(first, first, true);
      result.within_bodies += edges;
      if (edges > 0) result.pairs.push_back({i, i, edges});
    }
    for (int j = i + 1; j < count; ++j) {
      const Searchable& second = bodies[at(j)];
      if (!first.tree.extent().meets(second.tree.extent())) continue;
      const int edges =
          count_edges_through(first, second, false) + count_edges_through(second, first, false);
      result.between_bodies += edges;
      if (edges > 0) result.pairs.push_back({i, j, edges});
    }
  }
  return result;
}

const CrossingPair* first_crossing_bodies(const Crossings& crossings) {
  const auto found =
      std::find_if(crossings.pairs.begin(), crossings.pairs.end(),
                   [](const CrossingPair& pair) { return pair.first != pair.second; });
  return found == crossings.pairs.end() ? nullptr : &*found;
}

}  // namespace pneuma::sim
