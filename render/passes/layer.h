// The bodies, and what is drawn over them, over the ground and the background.
#pragma once

#include <memory>
#include <span>

#include "render/frame/view.h"
#include "render/passes/target.h"

namespace pneuma::render {

/// With one sample a pixel, bodies are drawn on the picture itself. With several, on a layer of
/// their own, transparent where nothing is drawn, with colours multiplied by their alpha: ground
/// and background have no edges worth several samples, and only the part of the picture that holds
/// bodies has samples to clear, test and average.
class Layer {
 public:
  /// `target` must outlive it.
  Layer(Target& target, int samples);
  ~Layer();

  /// After ground and background. Until end() depth is tested and, with several samples, nothing
  /// is drawn outside the region of the frame's bodies.
  void begin(const Frame& frame, const View& view, std::span<const SurfaceVertex> surface);
  /// What has been drawn is in the target's picture then.
  void end();

 private:
  struct Samples;

  Target& target_;
  std::unique_ptr<Samples> samples_;  // null with one a pixel
};

/// Blends what is drawn from here on, whose colours are not multiplied by their alpha, over what
/// is there.
void blend_over_layer();

}  // namespace pneuma::render
