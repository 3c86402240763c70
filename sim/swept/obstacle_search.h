// The features of a soft body and of an obstacle, which keeps its shape, that may touch in a step.
//
// A fine obstacle has hundreds of features beside each of a coarse body. Of these only few can be
// where the two surfaces meet first: a vertex of the obstacle only if the direction between them is
// one of its normals, which edges that lie in a hollow do not have at all; and nothing of a pair of
// triangles between which a plane passes while they move.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/swept/moving_surface.h"
#include "sim/swept/obstacle_shape.h"

namespace pneuma::sim {

/// A soft body and an obstacle that stays where it is, in these axes.
struct BesideObstacle {
  const MovingSurface& soft;      // its boxes may be old
  const MovingSurface& obstacle;  // refitted, and its place kept
  const ObstacleShape& shape;
  bool soft_is_first = true;  // in the pairs that are found
  double near = 0.0;          // m, up to which features are in contact
  double least = 0.0;         // m, which they must keep on their ways
  double allowance = 0.0;     // m, by which the ends of the soft body may still change
};

/// Triangles of a soft body and of an obstacle.
struct TrianglePair {
  int soft = 0;
  int obstacle = 0;
};

class ObstacleSearch {
 public:
  /// Fills `near` with all triangles that may come within `near` of each other, also if the ends
  /// change by the allowance, in an order that depends on the surfaces only.
  void find_near_triangles(const BesideObstacle& pair, std::vector<TrianglePair>& near);
  /// Of these, appends pairs of features, each once: of those that may come within `near` on their
  /// ways all that may be nearest to each other at the start, of what is beside them.
  void find_nearest_at_start(const BesideObstacle& pair, std::span<const TrianglePair> near,
                             std::vector<NearFeatures>& pairs);
  /// Those that may be the first of their surfaces to come within `least`, and vertices of the soft
  /// body that may come within `near`.
  void find_first_to_pass(const BesideObstacle& pair, std::span<const TrianglePair> near,
                          std::vector<NearFeatures>& pairs);

 private:
  /// A triangle of the soft body, and a plane that moves with it: nothing of it is above that.
  struct SoftTriangle {
    WayBox box;               // `near` larger
    Vec4d normal_at_start{};  // unit
    Vec4d normal_at_end{};
    double at_start = 0.0;  // m, along the normal
    double at_end = 0.0;
    double between = 0.0;  // Bernstein's middle coefficient of a quadratic function of time
    Vec3x4 corners_at_start{};
    Vec3x4 corners_at_end{};
  };
  struct SoftEdge {
    ObstacleShape::EdgeSides sides;
    WayBox box;
  };
  class TriangleSearch;
  class FeatureSearch;

  void find(const BesideObstacle& pair, bool may_pass, std::span<const TrianglePair> near,
            std::vector<NearFeatures>& pairs);

  // Allocated no more once the number of triangles has peaked.
  WayBoxes boxes_;  // of the soft body, wide enough for the allowance
  std::vector<SoftTriangle> triangles_;
  std::vector<SoftEdge> edges_;
  std::uint64_t search_ = 0;                             // the number of this one
  std::vector<std::uint64_t> known_in_, edge_known_in_;  // per triangle and per edge: the last one
};

}  // namespace pneuma::sim
