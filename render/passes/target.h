// The framebuffer object a finished picture is put together in, and the way out of it.
#pragma once

#include <cstdint>
#include <vector>

#include "render/image/image.h"
#include "render/passes/gl_objects.h"

namespace pneuma::render {

/// One sample a pixel; sRGB as bytes (see look.h).
class Target {
 public:
  Target(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  /// What is drawn to it can be tested for depth from here on.
  void add_depth();

  /// Binds it as what is drawn to. It holds what was drawn last.
  void begin();

  /// Reads the finished picture.
  void read(Image& image);

 private:
  int width_;
  int height_;
  Framebuffer framebuffer_;
  Renderbuffer colour_;
  Renderbuffer depth_;
  std::vector<std::uint8_t> rgba_;  // of some rows
};

/// Throws GlError unless the bound framebuffer can be drawn to.
void check_framebuffer();

}  // namespace pneuma::render
