// What is seen where nothing else is: a soft vertical gradient.
#pragma once

#include "render/passes/gl_objects.h"
#include "render/passes/program.h"
#include "render/passes/view.h"

namespace pneuma::render {

class Background {
 public:
  Background();

  /// Fills the whole picture.
  void draw(const View& view);

 private:
  VertexArray no_attributes_;
  Program program_;
  GLint picture_height_;
};

}  // namespace pneuma::render
