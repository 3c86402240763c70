// What is seen where nothing else is: a soft vertical gradient.
#pragma once

#include "render/frame/view.h"
#include "render/passes/full_screen.h"

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
