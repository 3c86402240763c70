#include "app/render/draw_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "app/host/background.h"
#include "app/host/clock.h"
#include "app/host/interrupt.h"
#include "app/render/run_notices.h"
#include "render/image/png.h"
#include "sim/base/file.h"
#include "sim/inspect/checkpoint.h"

namespace pneuma::app {
namespace {

/// A frame to be drawn, and what is to become of it: all of the simulation that is needed for it,
/// so that the simulation can go on.
struct TakenFrame {
  render::Frame picture;
  std::optional<render::Frame> overlay;
  std::int64_t number = 0;
  FrameState state;
  std::vector<std::uint8_t> checkpoint;
  FrameSeconds seconds;
};

/// The same when it is drawn.
struct DrawnFrame {
  TakenFrame of;
  render::Image picture;
  std::optional<render::Image> overlay;
};

/// Draws frames and hands them to a thread that encodes and writes them while the next is made: at
/// most four frames are in memory, one being made, one drawn, one waiting and one being written.
/// The order of files, journal and checkpoint stays what it is without that thread.
class FrameWriter {
 public:
  explicit FrameWriter(const FrameOutput& output) : output_(output) {}

  /// What is needed to draw the present state. On one thread at a time, also beside write().
  TakenFrame take(const Simulation& simulation) {
    TakenFrame frame;
    Stopwatch watch;
    const render::Camera camera = output_.camera.at(simulation.world());
    const double look_ahead = watch.lap();
    const bool is_first = std::exchange(none_taken_, false);
    if (is_first && output_.camera.seen()) frame.seconds.look_ahead = look_ahead;
    output_.fields.see(simulation.world());
    frame.picture = build(simulation, camera, output_.pictures.show);
    if (output_.pictures.overlay) {
      frame.overlay = build(simulation, camera, *output_.pictures.overlay);
    }
    frame.seconds.mesh = watch.lap();
    frame.number = simulation.frame();
    frame.state = frame_state(simulation, {camera, output_.camera.seen(), output_.fields.seen()});
    frame.checkpoint = sim::save_state(simulation.world());
    return frame;
  }

  void write(TakenFrame taken) {
    const auto frame = std::make_shared<DrawnFrame>();
    Stopwatch watch;
    output_.renderer.draw(taken.picture, frame->picture);
    if (taken.overlay) output_.renderer.draw(*taken.overlay, frame->overlay.emplace());
    taken.seconds.draw = watch.lap();
    taken.seconds.total = since_last_frame_.lap() - taken.seconds.look_ahead.value_or(0.0);
    frame->of = std::move(taken);
    finishing_.submit([this, frame] { finish(*frame); });
  }

  /// Waits until everything is on disk.
  void wait() { finishing_.finish(); }

 private:
  render::Frame build(const Simulation& simulation, const render::Camera& camera,
                      const Show& show) const {
    return output_.builder.build(simulation.world(), camera, simulation.contacts(),
                                 output_.fields.with_end(show));
  }

  void finish(DrawnFrame& frame) const {
    const RunFolder& folder = output_.log.folder();
    TakenFrame& of = frame.of;
    PictureBytes bytes;
    bytes.frame = save(frame.picture, folder.frame(of.number), of.seconds);
    if (frame.overlay) bytes.overlay = save(*frame.overlay, folder.overlay(of.number), of.seconds);
    output_.log.append_frame(std::move(of.state), bytes, of.seconds, of.checkpoint);
  }

  /// Returns the size of the file.
  static std::size_t save(const render::Image& image, const std::filesystem::path& file,
                          FrameSeconds& seconds) {
    Stopwatch watch;
    const std::vector<std::uint8_t> png = render::encode_png(image);
    seconds.png += watch.lap();
    base::write_file_atomically(file.string(), png);
    seconds.write += watch.lap();
    return png.size();
  }

  FrameOutput output_;
  bool none_taken_ = true;
  Stopwatch since_last_frame_;
  Background finishing_{1};  // the last member: it ends before what its jobs use
};

struct RunNotices {
  DividedSteps divided;
  CrossedFrames crossed;
  PressedBodies pressed;
  UnseenFrames unseen;

  void add(const Simulation& simulation, const TakenFrame& frame, Progress& progress) {
    crossed.add(simulation, frame.state, progress);
    pressed.add(simulation.world());
    const scenes::PictureScene& size = simulation.scene().picture;
    unseen.add(simulation.world(), frame.picture.camera,
               static_cast<double>(size.width) / size.height);
  }
  void summarise(Progress& progress, bool is_resumed) const {
    divided.summarise(progress);
    crossed.summarise(progress, is_resumed);
    pressed.summarise(progress);
    unseen.summarise(progress);
  }
};

}  // namespace

void draw_frames(Simulation& simulation, std::int64_t last, const FrameOutput& output,
                 Progress& progress) {
  FrameWriter writer(output);
  RunNotices notices;
  Stopwatch watch;
  const std::int64_t first = output.log.next_frame();
  const double time_at_start = sim::time(simulation.world());
  ProgressState state;
  state.last = last;
  std::optional<TakenFrame> next;  // of the present state, unless it is drawn already
  std::optional<SimulatedFrame> simulated;
  const auto take_next = [&] {
    if (simulation.frame() >= first) {
      next = writer.take(simulation);
    } else {
      output.camera.see(simulation.world());
      output.fields.see(simulation.world());
    }
  };
  Background making(1);
  const auto wait_for_next = [&] {
    try {
      making.finish();
      throw_if_interrupted();
    } catch (...) {
      writer.wait();  // a frame that could not be written is the first thing to know
      throw;
    }
  };
  output.camera.keep_frames();
  take_next();
  for (;;) {
    state.frame = simulation.frame();
    state.time = sim::time(simulation.world());
    state.simulated = state.time - time_at_start;
    if (next) notices.add(simulation, *next, progress);
    std::optional<TakenFrame> frame = std::exchange(next, std::nullopt);
    const bool more = state.frame < last;
    if (more) {
      simulated = output.camera.take_frame(state.frame + 1);
      output.camera.prepare_next();
      making.submit([&] {
        if (simulated) {
          simulation.adopt(*std::exchange(simulated, std::nullopt));
        } else {
          simulation.advance_frame();
        }
        take_next();
      });
    }
    if (frame) {
      const double look_ahead = frame->seconds.look_ahead.value_or(0.0);
      state.look_ahead += look_ahead;
      state.elapsed -= look_ahead;
      writer.write(std::move(*frame));
      ++state.drawn;
    }
    state.elapsed += watch.lap();
    state.crossed = notices.crossed.count();
    progress.show(progress_line(state));
    if (!more) break;
    wait_for_next();
    notices.divided.add(simulation, progress);
  }
  writer.wait();
  state.elapsed += watch.lap();
  progress.say(summary_line(state));
  notices.summarise(progress, !output.log.is_new());
}

}  // namespace pneuma::app
