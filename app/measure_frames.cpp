#include "app/measure_frames.h"

#include <utility>
#include <vector>

#include "app/build_frame.h"
#include "render/image/png.h"
#include "render/renderer.h"

namespace pneuma::app {
namespace {

// The first ones upload meshes, and llvmpipe compiles what it draws with.
constexpr int warm_up_frames = 3;

/// One list of seconds for each part of a frame, and for the whole.
struct Readings {
  std::vector<double> total, steps, build, draw, encode;
};

class FrameMaker {
 public:
  FrameMaker(Replay& replay, int steps_per_frame, const scenes::Scene& scene,
             const render::Camera& camera)
      : replay_(replay),
        steps_per_frame_(steps_per_frame),
        renderer_({.width = scene.picture.width,
                   .height = scene.picture.height,
                   .samples = scene.picture.samples}),
        builder_(scene, replay.world(), camera) {}

  void make(Readings& readings) {
    replay_.prepare(steps_per_frame_);
    const Clock::time_point start = Clock::now();
    replay_.run(steps_per_frame_);
    const Clock::time_point stepped = Clock::now();
    const render::Frame frame = builder_.build(replay_.world());
    const Clock::time_point built = Clock::now();
    renderer_.draw(frame, image_);
    const Clock::time_point drawn = Clock::now();
    const std::vector<std::uint8_t> png = render::encode_png(image_);
    const Clock::time_point encoded = Clock::now();

    const auto seconds = [](Clock::time_point from, Clock::time_point to) {
      return std::chrono::duration<double>(to - from).count();
    };
    readings.total.push_back(seconds(start, encoded));
    readings.steps.push_back(seconds(start, stepped));
    readings.build.push_back(seconds(stepped, built));
    readings.draw.push_back(seconds(built, drawn));
    readings.encode.push_back(seconds(drawn, encoded));
  }

 private:
  Replay& replay_;
  int steps_per_frame_;
  render::Renderer renderer_;
  FrameBuilder builder_;
  render::Image image_;
};

}  // namespace

FrameTimes measure_frames(Replay& replay, int steps_per_frame, const scenes::Scene& scene,
                          const render::Camera& camera, const Budget& budget) {
  FrameMaker maker(replay, steps_per_frame, scene, camera);
  Readings ignored, readings;
  for (int i = 0; i < warm_up_frames; ++i) maker.make(ignored);
  while (budget.more(static_cast<std::int64_t>(readings.total.size()))) maker.make(readings);

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
