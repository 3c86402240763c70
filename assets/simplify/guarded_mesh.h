// A closed surface that changes edge by edge and never comes to touch itself.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "assets/simplify/editable_mesh.h"
#include "assets/simplify/grid_triangle.h"

namespace pneuma::assets {

/// The extent of the surface is the unit of length here. The vertices lie on a grid of 2^-30 of it,
/// where it is decided exactly what touches.
class GuardedMesh {
 public:
  /// `edge`: about how long edges will be, in metres as the mesh.
  GuardedMesh(sim::TriangleMesh mesh, double edge);

  const EditableMesh& mesh() const { return mesh_; }
  const Vec3& position(int vertex) const { return mesh_.position(vertex); }

  /// Whether the surface still touches itself nowhere when the triangles `now` take the place of
  /// those numbered `before`, with `vertex` at `place`. No other triangle has that vertex.
  bool stays_apart(std::span<const int> before, std::span<const sim::Triangle> now, int vertex,
                   const Vec3& place);

  void collapse(int a, int b, const Vec3& place);
  void flip(int a, int b);
  void move(int vertex, const Vec3& place);

  /// Without what is gone, in metres.
  sim::TriangleMesh result() const;

  /// The point of the grid next to `place`.
  static Vec3 on_grid(const Vec3& place);
  /// Whether the grid reaches so far.
  static bool is_on_grid(const Vec3& place);

 private:
  using Cell = std::array<int, 3>;

  GridTriangle grid_triangle(const sim::Triangle& triangle) const;
  Cell cell_of(const base::GridPoint& point) const;
  template <class Visit>
  void for_each_cell(const GridBox& box, const Visit& visit);
  void enter(std::span<const int> triangles);
  void leave(std::span<const int> triangles);
  void find_near(const GridBox& box, std::span<const int> except);

  EditableMesh mesh_;
  Vec3 centre_;
  double extent_;
  std::vector<base::GridPoint> points_;  // of the vertices
  int cells_along_;                      // each axis
  std::vector<std::vector<int>> cells_;  // triangles whose boxes overlap the cell's
  std::vector<int> last_look_;           // of each triangle, at which find_near met it last
  int look_ = 0;
  std::vector<GridTriangle> near_, now_;  // of stays_apart, kept for their memory
};

}  // namespace pneuma::assets
