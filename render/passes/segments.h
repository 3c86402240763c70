// Lines with a width in pixels, which the core profile itself does not draw.
#pragma once

#include <vector>

#include "render/frame/view.h"
#include "render/passes/instanced_quads.h"

namespace pneuma::render {

class Segments {
 public:
  Segments();

  /// The frame's own lines. Those that shine through one mesh need the marks (mesh_marks.h).
  void draw_lines(const View& view, const std::vector<Line>& lines);

  /// The meshes' edges, over the surfaces.
  void draw_wireframe(const View& view, const std::vector<Mesh>& meshes);

 private:
  struct Instance {
    Vec3f from;
    Vec3f to;
    Colour colour;
    float width;  // pixels
  };

  /// Those that shine through one mesh, over it and the ground.
  void draw_through(const View& view, const std::vector<Line>& lines);
  void add(const View& view, const Line& line);
  void draw(const View& view, GLenum depth_test, float opacity);

  std::vector<Instance> instances_;
  InstancedQuads<Instance> quads_;
  GLint near_;
};

}  // namespace pneuma::render
