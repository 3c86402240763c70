// The caption: light letters on a dark, translucent panel, readable on any ground.
#pragma once

#include <string>
#include <vector>

#include "render/frame/view.h"
#include "render/passes/gl_objects.h"
#include "render/passes/program.h"

namespace pneuma::render {

class Lettering {
 public:
  Lettering();

  /// In the lower left corner, growing upwards with the number of lines; lines that are too long
  /// for the picture go on in the next. Characters outside printable ASCII are shown as '?'.
  void draw(const View& view, const std::string& text);

 private:
  Vao vao_;
  Buffer vertices_;
  Program program_;
  GLint picture_size_;
};

}  // namespace pneuma::render
