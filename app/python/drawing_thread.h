// A renderer that can be used from any thread: an OpenGL context belongs to the thread that made
// it, so it has one of its own.
#pragma once

#include <memory>

#include "app/host/background.h"
#include "render/image/image.h"
#include "render/renderer.h"

namespace pneuma::app {

class DrawingThread {
 public:
  DrawingThread() = default;
  ~DrawingThread();
  DrawingThread(const DrawingThread&) = delete;
  DrawingThread& operator=(const DrawingThread&) = delete;

  /// Makes a new renderer when the size or the samples differ from the last picture's. Throws
  /// render::GlError.
  render::Image draw(const render::RenderOptions& options, const render::Frame& frame);

 private:
  render::RenderOptions options_;
  std::unique_ptr<render::Renderer> renderer_;
  Background thread_{1};  // the last member: it ends before what it uses
};

}  // namespace pneuma::app
