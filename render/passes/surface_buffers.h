// The surface of a frame in GL's memory.
#pragma once

#include <vector>

#include "render/geometry/drawn_surface.h"
#include "render/passes/gl_objects.h"

namespace pneuma::render {

/// All meshes are one draw call, which on llvmpipe costs as much as some hundred triangles.
/// Attributes: 0 position, 1 normal, 2 material, 3 bounced light, 4 openness,
/// 5 and 6 boxes near by.
class SurfaceBuffers {
 public:
  SurfaceBuffers();

  void upload(const DrawnSurface& surface);
  void upload_light(const std::vector<IndirectLight>& light);

  /// With the program in use.
  void draw() const;
  void draw_sunward() const;
  void draw_averted() const;
  void draw(const TriangleRange& range) const;

 private:
  void draw(GLsizei first_index, GLsizei count) const;

  Vao vao_;
  Buffer vertices_;
  Buffer light_;
  Buffer indices_;
  GLsizei index_count_ = 0;
  GLsizei sunward_count_ = 0;  // indices
};

}  // namespace pneuma::render
