// Points as round discs with a dark rim.
#pragma once

#include <vector>

#include "render/passes/gl_objects.h"
#include "render/passes/program.h"
#include "render/passes/view.h"

namespace pneuma::render {

class Discs {
 public:
  Discs();
  void draw(const View& view, const std::vector<Point>& points);

 private:
  struct Instance {
    Vec3f position;
    Colour colour;
    float radius;  // pixels
  };

  void upload(const std::vector<Instance>& instances);

  VertexArray vertex_array_;
  Buffer instances_buffer_;
  Program program_;
  GLint view_;
  GLint projection_;
  GLint picture_size_;
  GLint opacity_;
};

}  // namespace pneuma::render
