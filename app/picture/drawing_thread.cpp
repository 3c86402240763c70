#include "app/picture/drawing_thread.h"

#include <utility>

namespace pneuma::app {

DrawingThread::DrawingThread(const render::RenderOptions& options) : options_(options) {}

DrawingThread::~DrawingThread() {
  thread_.submit([this] { renderer_.reset(); });
}

std::future<void> DrawingThread::submit(Job job) {
  // An error is the future's: a Background that has thrown does no further job.
  const auto task = std::make_shared<std::packaged_task<void()>>([this, job = std::move(job)] {
    if (!renderer_) renderer_ = std::make_unique<render::Renderer>(options_);
    job(*renderer_);
  });
  std::future<void> done = task->get_future();
  thread_.submit([task] { (*task)(); });
  return done;
}

Drawing::Drawing(const render::RenderOptions& options)
    : threads_{DrawingThread(options), DrawingThread(options)} {
  threads_[0]
      .submit([this](const render::Renderer& renderer) { description_ = renderer.description(); })
      .get();
}

std::future<void> Drawing::submit(DrawingThread::Job job) {
  DrawingThread& thread = threads_[next_];
  next_ = (next_ + 1) % threads;
  return thread.submit(std::move(job));
}

render::Image Drawing::draw(const render::Frame& frame) {
  render::Image image;
  submit([&](render::Renderer& renderer) { renderer.draw(frame, image); }).get();
  return image;
}

}  // namespace pneuma::app
