// What is seen where nothing else is: a soft vertical gradient.
#pragma once

#include "render/passes/gl_objects.h"
#include "render/passes/program.h"
#include "render/passes/view.h"

namespace pneuma::render {

class Background {
 public:
  Background();

  /// Last of the opaque passes: fills what has been left at the far end of the depth buffer, from
  /// `first_row` (counted from the picture's foot) upwards. Even asking each sample has its price.
  void draw(const View& view, int first_row);

 private:
  VertexArray no_attributes_;
  Program program_;
  GLint picture_height_;
};

}  // namespace pneuma::render
