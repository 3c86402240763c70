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
  explicit FrameWriter(const FrameOutput& output) : output_(output) {}

  void write(const Simulation& simulation) {
    const RunFolder& folder = output_.folder;
    const std::int64_t frame = simulation.frame();
    FrameSeconds seconds;
    PictureBytes bytes;
    bytes.frame = draw(simulation, output_.pictures.show, folder.frame(frame), seconds);
    if (output_.pictures.overlay) {
      bytes.overlay = draw(simulation, *output_.pictures.overlay, folder.overlay(frame), seconds);
    }
    seconds.total = since_last_frame_.lap();
    output_.journal.append(recorder_.line(simulation, bytes, seconds));
    render::write_file_atomically(folder.state().string(), sim::save_state(simulation.world()));
  }

 private:
  /// Returns the size of the file.
  std::size_t draw(const Simulation& simulation, Show show, const std::filesystem::path& file,
                   FrameSeconds& seconds) {
    Stopwatch watch;
    output_.renderer.draw(
        output_.builder.build(simulation.world(), simulation.stepper().contacts(), show), image_);
    seconds.draw += watch.lap();
    const std::vector<std::uint8_t> png = render::encode_png(image_);
    seconds.png += watch.lap();
    render::write_file_atomically(file.string(), png);
    seconds.write += watch.lap();
    return png.size();
  }

  FrameOutput output_;
  FrameRecorder recorder_;
  render::Image image_;
  Stopwatch since_last_frame_;
};

}  // namespace

void draw_frames(Simulation& simulation, std::int64_t next, std::int64_t last,
                 const FrameOutput& output, Progress& progress) {
  FrameWriter writer(output);
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
