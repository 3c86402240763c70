// What is seen where nothing else is: a soft vertical gradient.
#pragma once

#include "render/passes/full_screen.h"
#include "render/passes/view.h"

namespace pneuma::render {

class Background {
 public:
  Background();

  /// Fills the whole picture.
  void draw(const View& view);

 private:
  FullScreen gradient_;
  GLint picture_height_;
};

}  // namespace pneuma::render
