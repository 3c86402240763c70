#include "app/bench/measure_frames.h"

#include <chrono>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include "app/host/background.h"
#include "app/picture/build_frame.h"
#include "app/picture/drawing_thread.h"
#include "render/image/png.h"
#include "render/renderer.h"

namespace pneuma::app {
namespace {

// The first ones upload meshes, and llvmpipe compiles what it draws with.
constexpr int warm_up_frames = 3;

/// One list of seconds for each part of a frame. `draw` and `encode` are another thread's until
/// finish(), `steps` until make() returns.
struct Readings {
  std::vector<double> steps, build, draw, encode;
};

class FrameMaker {
 public:
  FrameMaker(Replay& replay, int steps_per_frame, const scenes::Scene& scene,
             const render::Camera& camera, std::optional<render::Backend> backend)
      : replay_(replay),
        steps_per_frame_(steps_per_frame),
        drawing_({.width = scene.picture.width,
                  .height = scene.picture.height,
                  .samples = scene.picture.samples,
                  .backend = backend}),
        builder_(scene, replay.world(), camera) {}

  /// Hands over the replay's present state to be drawn while it goes on to the next.
  void make(Readings& readings) {
    replay_.prepare(steps_per_frame_);
    const auto frame = std::make_shared<DrawnFrame>();
    const Clock::time_point start = Clock::now();
    frame->of = builder_.build(replay_.world());
    readings.build.push_back(seconds_since(start));
    stepping_.submit([this, &readings] {
      const Clock::time_point begin = Clock::now();
      replay_.run(steps_per_frame_);
      readings.steps.push_back(seconds_since(begin));
    });
    const std::shared_future<void> drawn = drawing_.submit([frame](render::Renderer& renderer) {
      const Clock::time_point begin = Clock::now();
      renderer.draw(frame->of, frame->image);
      frame->seconds = seconds_since(begin);
    });
    encoding_.submit([this, frame, drawn, &readings] {
      drawn.get();
      readings.draw.push_back(frame->seconds);
      const Clock::time_point begin = Clock::now();
      const std::vector<std::uint8_t> png = render::encode_png(frame->image);
      readings.encode.push_back(seconds_since(begin));
      finished_.push_back(Clock::now());
    });
    stepping_.finish();
  }

  /// Waits for the frames that are still being made.
  void finish() { encoding_.finish(); }

  /// After finish(): seconds a frame. Frames that are drawn side by side may be finished together,
  /// so that each counts as its part of the time for as many as are.
  std::vector<double> totals() const {
    std::vector<double> seconds;
    for (std::size_t i = warm_up_frames; i < finished_.size(); ++i) {
      const std::chrono::duration<double> taken = finished_[i] - finished_[i - Drawing::threads];
      seconds.push_back(taken.count() / static_cast<double>(Drawing::threads));
    }
    return seconds;
  }

 private:
  struct DrawnFrame {
    render::Frame of;
    render::Image image;
    double seconds = 0.0;  // of drawing
  };

  Replay& replay_;
  int steps_per_frame_;
  Drawing drawing_;
  FrameBuilder builder_;
  std::vector<Clock::time_point> finished_;  // by the encoding thread
  // The last members: they end before what their jobs use.
  Background stepping_{1};
  Background encoding_{1};
};

}  // namespace

FrameTimes measure_frames(Replay& replay, int steps_per_frame, const scenes::Scene& scene,
                          const render::Camera& camera, const Budget& budget,
                          std::optional<render::Backend> backend) {
  Readings ignored, readings;
  FrameMaker maker(replay, steps_per_frame, scene, camera, backend);
  for (int i = 0; i < warm_up_frames; ++i) maker.make(ignored);  // also fills the pipeline
  for (std::int64_t i = 0; budget.more(i); ++i) maker.make(readings);
  maker.finish();

  FrameTimes times;
  times.frames = static_cast<std::int64_t>(readings.encode.size());
  times.width = scene.picture.width;
  times.height = scene.picture.height;
  times.seconds = spread(maker.totals());
  times.steps = spread(std::move(readings.steps)).median;
  times.build = spread(std::move(readings.build)).median;
  times.draw = spread(std::move(readings.draw)).median;
  times.encode = spread(std::move(readings.encode)).median;
  return times;
}

}  // namespace pneuma::app
