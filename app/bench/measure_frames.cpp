#include "app/bench/measure_frames.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/host/background.h"
#include "app/picture/build_frame.h"
#include "render/image/png.h"
#include "render/renderer.h"

namespace pneuma::app {
namespace {

// The first ones upload meshes, and llvmpipe compiles what it draws with.
constexpr int warm_up_frames = 3;

/// One list of seconds for each part of a frame, and for the whole. `encode` is another thread's
/// until finish(), `steps` and `build` until make() returns.
struct Readings {
  std::vector<double> total, steps, build, draw, encode;
};

class FrameMaker {
 public:
  FrameMaker(Replay& replay, int steps_per_frame, const scenes::Scene& scene, RunCamera& camera,
             const Show& show, std::optional<render::Backend> backend)
      : replay_(replay),
        steps_per_frame_(steps_per_frame),
        show_(show),
        renderer_({.width = scene.picture.width,
                   .height = scene.picture.height,
                   .samples = scene.picture.samples,
                   .backend = backend}),
        builder_(scene, replay.world()),
        camera_(camera) {}

  /// Draws the replay's present state while it goes on to the next.
  void make(Readings& readings) {
    if (!next_) build(readings);
    replay_.prepare(steps_per_frame_);
    const Clock::time_point start = Clock::now();
    const render::Frame frame = std::move(*next_);
    making_.submit([this, &readings] {
      const Clock::time_point begin = Clock::now();
      replay_.run(steps_per_frame_);
      readings.steps.push_back(seconds_since(begin));
      build(readings);
    });
    const auto image = std::make_shared<render::Image>();
    const Clock::time_point submitted = Clock::now();
    renderer_.draw(frame, *image);
    readings.draw.push_back(seconds_since(submitted));
    encoding_.submit([image, &readings] {
      const Clock::time_point begin = Clock::now();
      const std::vector<std::uint8_t> png = render::encode_png(*image);
      readings.encode.push_back(seconds_since(begin));
    });
    making_.finish();
    readings.total.push_back(seconds_since(start));
  }

  /// Waits for the frames that are still being encoded.
  void finish() { encoding_.finish(); }

 private:
  void build(Readings& readings) {
    const Clock::time_point begin = Clock::now();
    replay_.place_obstacles();
    next_ = builder_.build(replay_.world(), camera_.at(replay_.world()),
                           replay_.stepper().contacts(), show_);
    readings.build.push_back(seconds_since(begin));
  }

  Replay& replay_;
  int steps_per_frame_;
  Show show_;
  render::Renderer renderer_;
  FrameBuilder builder_;
  RunCamera& camera_;
  std::optional<render::Frame> next_;
  // The last members: they end before what their jobs use.
  Background making_{1};
  Background encoding_{1};
};

}  // namespace

FrameTimes measure_frames(Replay& replay, int steps_per_frame, const scenes::Scene& scene,
                          RunCamera& camera, const Show& show, const Budget& budget,
                          std::optional<render::Backend> backend) {
  Readings ignored, readings;
  FrameMaker maker(replay, steps_per_frame, scene, camera, show, backend);
  for (int i = 0; i < warm_up_frames; ++i) maker.make(ignored);  // also fills the pipeline
  while (budget.more(static_cast<std::int64_t>(readings.total.size()))) maker.make(readings);
  maker.finish();

  FrameTimes times;
  times.frames = static_cast<std::int64_t>(readings.total.size());
  times.width = scene.picture.width;
  times.height = scene.picture.height;
  times.seconds = spread(std::move(readings.total));
  times.steps = spread(std::move(readings.steps)).median;
  times.build = spread(std::move(readings.build)).median;
  times.draw = spread(std::move(readings.draw)).median;
  times.encode = spread(std::move(readings.encode)).median;
  return times;
}

}  // namespace pneuma::app
