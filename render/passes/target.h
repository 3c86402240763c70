// The framebuffer objects a picture is drawn into, and the way out of them.
#pragma once

#include "render/image/image.h"
#include "render/passes/gl_objects.h"

namespace pneuma::render {

/// A multisampled framebuffer, and a plain one that it is resolved into. Both hold sRGB as bytes
/// (see look.h).
class Target {
 public:
  Target(int width, int height, int samples);

  /// Binds the multisampled framebuffer, with its depth cleared. The colour is left as it is, since
  /// the background is drawn wherever nothing else is.
  void begin();

  /// Averages the samples; what is drawn from here on has one sample a pixel and no depth.
  void resolve();

  /// Reads the finished picture.
  void read(Image& image);

 private:
  int width_;
  int height_;
  int samples_;
  Framebuffer framebuffer_;
  Renderbuffer colour_;
  Renderbuffer depth_;
  Framebuffer resolved_framebuffer_;
  Renderbuffer resolved_colour_;
  std::vector<std::uint8_t> rgba_;
};

}  // namespace pneuma::render
