// Which mesh is seen where, as numbers in the stencil buffer.
#pragma once

#include <cstdint>

#include "render/passes/program.h"
#include "render/passes/surface_buffers.h"

namespace pneuma::render {

class MeshMarks {
 public:
  MeshMarks();

  /// After the surfaces, whose depths it compares.
  void draw(const View& view, const DrawnSurface& surface, const SurfaceBuffers& buffers) const;

  /// Where no mesh is seen.
  static constexpr GLint none = 0;
  /// The stencil has eight bits: of more meshes, those 255 apart share a number.
  static GLint of(std::uint32_t mesh) { return 1 + static_cast<GLint>(mesh % 255); }

 private:
  Program program_;
  GLint view_projection_;
};

}  // namespace pneuma::render
