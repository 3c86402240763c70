// Renderers on threads of their own: an OpenGL context belongs to the thread that made it.
#pragma once

#include <array>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "app/host/background.h"
#include "render/image/image.h"
#include "render/renderer.h"

namespace pneuma::app {

class DrawingThread {
 public:
  using Job = std::function<void(render::Renderer& renderer)>;

  /// The first job makes the renderer.
  explicit DrawingThread(const render::RenderOptions& options);
  ~DrawingThread();
  DrawingThread(const DrawingThread&) = delete;
  DrawingThread& operator=(const DrawingThread&) = delete;

  /// Waits while another job waits. The future throws what the job throws, or render::GlError.
  std::future<void> submit(Job job);

 private:
  render::RenderOptions options_;
  std::unique_ptr<render::Renderer> renderer_;
  Background thread_{1};  // the last member: it ends before what it uses
};

/// Draws frames side by side: while the rasteriser's threads are at one, the CPU's part of the next
/// is done. A third would wait, as there is but one rasteriser in a process.
class Drawing {
 public:
  static constexpr std::size_t threads = 2;

  /// Makes the first renderer; another one when it is needed. Throws render::GlError.
  explicit Drawing(const render::RenderOptions& options);

  /// By the threads in turn.
  std::future<void> submit(DrawingThread::Job job);
  /// One frame, at once.
  render::Image draw(const render::Frame& frame);

  const std::string& description() const { return description_; }  // of the renderer

 private:
  std::array<DrawingThread, threads> threads_;
  std::size_t next_ = 0;
  std::string description_;
};

}  // namespace pneuma::app
