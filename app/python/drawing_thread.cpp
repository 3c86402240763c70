#include "app/python/drawing_thread.h"

#include <exception>

namespace pneuma::app {
namespace {

bool same(const render::RenderOptions& a, const render::RenderOptions& b) {
  return a.width == b.width && a.height == b.height && a.samples == b.samples;
}

}  // namespace

DrawingThread::~DrawingThread() {
  thread_.submit([this] { renderer_.reset(); });
}

render::Image DrawingThread::draw(const render::RenderOptions& options,
                                  const render::Frame& frame) {
  render::Image image;
  std::exception_ptr error;
  thread_.submit([&] {
    try {
      if (!renderer_ || !same(options, options_)) {
        renderer_.reset();
        renderer_ = std::make_unique<render::Renderer>(options);
        options_ = options;
      }
      renderer_->draw(frame, image);
    } catch (...) {  // a thread that has thrown does no further job
      error = std::current_exception();
    }
  });
  thread_.finish();
  if (error) std::rethrow_exception(error);
  return image;
}

}  // namespace pneuma::app
