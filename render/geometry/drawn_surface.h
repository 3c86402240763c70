// The meshes of a frame as one list of triangles, rounded where they may be.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "render/frame/surface_vertex.h"
#include "render/frame/view.h"
#include "render/geometry/refine.h"

namespace pneuma::render {

/// What the light does to a place on a surface beside the sun's.
struct IndirectLight {
  /// As of a box that is too far away to take any.
  static inline const Eigen::Vector4f no_box = {4.0f, 4.0f, 4.0f, 1.0f};

  Vec3f bounced = Vec3f::Zero();                      // from other bodies, over pi
  Eigen::Vector2f open_to = Eigen::Vector2f::Ones();  // fraction seen of the sky; of the lit ground
  // The place in the axes of boxes that it nearly touches, and their half sides: box_contacts.h.
  std::array<Eigen::Vector4f, 2> near_boxes = {no_box, no_box};
};

/// The vertices of a mesh as they are lit: one for each of a smooth mesh; of one with sharp edges,
/// one for each normal that corners of a vertex have in common.
struct LitMesh {
  std::shared_ptr<const MeshShape> shape;
  bool smooth = false;
  std::size_t first = 0;  // of its vertices
  std::size_t count = 0;
};

struct TriangleRange {
  std::size_t first = 0;
  std::size_t end = 0;  // the one after the last
};

/// Keeps what follows from a mesh's shape alone.
class DrawnSurface {
 public:
  /// The frame must have passed check_frame.
  void build(const Frame& frame, const View& view);

  const std::vector<LitMesh>& lit_meshes() const { return lit_meshes_; }
  /// Of all lit meshes.
  const std::vector<Vec3f>& positions() const { return positions_; }
  const std::vector<Vec3f>& normals() const { return normals_; }
  /// Whether a triangle that faces the eye has light of it.
  const std::vector<char>& seen() const { return seen_; }

  const std::vector<SurfaceVertex>& vertices() const { return vertices_; }
  /// First those that the sun may reach, then those that are turned away from it; of both, first
  /// those of the nearest mesh, which hide others before these are shaded.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  std::size_t sunward_count() const { return sunward_count_; }
  std::size_t mesh_count() const { return parts_.size(); }
  /// The triangles of one of the frame's meshes: those that the sun may reach, and the others.
  const std::array<TriangleRange, 2>& triangles_of(std::size_t mesh) const { return parts_[mesh]; }
  /// Per drawn vertex the first of its mesh at the same point: itself where the mesh is smooth.
  const std::vector<std::uint32_t>& places() const { return places_; }

  /// From one light per lit vertex, one per drawn vertex.
  void spread(const std::vector<IndirectLight>& light, std::vector<IndirectLight>& drawn) const;

  /// How many shapes are kept at present.
  std::size_t shape_count() const { return shapes_.size(); }

 private:
  struct Shape {
    std::vector<Vec3f> colours;  // linear
    // Of a mesh with sharp edges:
    std::vector<Triangle> corners;       // lit vertices, per triangle
    std::vector<std::uint32_t> sources;  // per lit vertex: the mesh's
  };
  struct MeshTriangles {
    float depth;  // m before the eye, of the mesh's middle
    TriangleRange range;
    std::size_t mesh;  // of the frame
  };
  using Key = std::weak_ptr<const MeshShape>;

  static void share_corners(const MeshShape& shape, Shape& made);
  Shape& shape_of(const std::shared_ptr<const MeshShape>& shape);
  void add_smooth(const Mesh& mesh, const Frame& frame, const View& view);
  void add_flat(const Mesh& mesh, const Frame& frame, const View& view);
  void add_lit_mesh(const Mesh& mesh, std::size_t count);
  void add_corner_normals(const Mesh& mesh, const Shape& shape);
  void append(const Refinement& refinement);
  void order_triangles(const View& view);
  void find_seen(const Vec3f& eye);

  // Ordered by owner: a new shape at a dead one's address is another one.
  std::map<Key, Shape, std::owner_less<Key>> shapes_;
  std::vector<LitMesh> lit_meshes_;
  std::vector<Vec3f> positions_;
  std::vector<Vec3f> normals_;
  std::vector<char> seen_;
  std::vector<SurfacePoint> points_;  // of lit vertices, per drawn vertex
  std::vector<SurfaceVertex> vertices_;
  std::vector<Triangle> triangles_;
  std::size_t sunward_count_ = 0;
  std::vector<MeshTriangles> meshes_;
  std::vector<std::array<TriangleRange, 2>> parts_;  // per mesh
  std::vector<Triangle> sunward_, averted_;
  std::vector<std::uint32_t> places_;
};

}  // namespace pneuma::render
