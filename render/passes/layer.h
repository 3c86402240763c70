// The bodies, and what is drawn over them, on a layer of their own.
#pragma once

#include "render/frame/view.h"
#include "render/passes/full_screen.h"
#include "render/passes/gl_objects.h"

namespace pneuma::render {

/// Several samples a pixel with depth, transparent where nothing is drawn; colours are multiplied
/// by their alpha. Ground and background have no edges worth several samples: with the layer they
/// are drawn with one, and only the part of the picture that holds bodies has samples to clear,
/// test and average.
class Layer {
 public:
  Layer(int width, int height, int samples);

  /// Binds the layer, empty. Until end() nothing is drawn outside the region.
  void begin(const Region& region);
  void end();

  /// Averages the samples and puts them over what the framebuffer bound by now holds.
  void compose();

 private:
  void clear() const;

  GLenum texture_target_;
  int width_;
  int height_;
  Region region_;
  Texture colour_;
  Renderbuffer depth_;
  Framebuffer framebuffer_;
  FullScreen average_;
};

/// Blends what is drawn from here on, whose colours are not multiplied by their alpha, over what
/// the layer holds.
void blend_over_layer();

}  // namespace pneuma::render
