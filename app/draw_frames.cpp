#include "app/draw_frames.h"

#include <chrono>

#include "app/interrupt.h"
#include "app/run_record.h"
#include "render/image/file.h"
#include "render/image/png.h"
#include "sim/inspect/checkpoint.h"

namespace pneuma::app {
namespace {

using Clock = std::chrono::steady_clock;

class Stopwatch {
 public:
  /// Seconds since the last call or since it was made.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  Clock::time_point start_ = Clock::now();
};

class FrameWriter {
 public:
  FrameWriter(const FrameBuilder& builder, render::Renderer& renderer, const RunFolder& folder,
              Journal& journal)
      : builder_(builder), renderer_(renderer), folder_(folder), journal_(journal) {}

  void write(const Simulation& simulation) {
    FrameSeconds seconds;
    Stopwatch watch;
    renderer_.draw(builder_.build(simulation.world(), simulation.stepper().contacts()), image_);
    seconds.draw = watch.lap();
    const std::vector<std::uint8_t> png = render::encode_png(image_);
    seconds.png = watch.lap();
    render::write_file_atomically(folder_.frame(simulation.frame()).string(), png);
    seconds.write = watch.lap();
    seconds.total = since_last_frame_.lap();
    journal_.append(recorder_.line(simulation, png.size(), seconds));
    render::write_file_atomically(folder_.state().string(), sim::save_state(simulation.world()));
  }

 private:
  const FrameBuilder& builder_;
  render::Renderer& renderer_;
  const RunFolder& folder_;
  Journal& journal_;
  FrameRecorder recorder_;
  render::Image image_;
  Stopwatch since_last_frame_;
};

}  // namespace

void draw_frames(Simulation& simulation, std::int64_t next, std::int64_t last,
                 const FrameBuilder& builder, render::Renderer& renderer, const RunFolder& folder,
                 Journal& journal, Progress& progress) {
  FrameWriter writer(builder, renderer, folder, journal);
  Stopwatch watch;
  const double time_at_start = sim::time(simulation.world());
  ProgressState state;
  state.last = last;
  for (;;) {
    state.frame = simulation.frame();
    if (state.frame >= next) {
      writer.write(simulation);
      ++state.drawn;
    }
    state.time = sim::time(simulation.world());
    state.simulated = state.time - time_at_start;
    state.elapsed += watch.lap();
    progress.show(progress_line(state));
    if (state.frame >= last) break;
    throw_if_interrupted();
    simulation.advance_frame();
  }
  progress.say(summary_line(state));
}

}  // namespace pneuma::app
