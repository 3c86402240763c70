// The camera of each frame of a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "app/host/background.h"
#include "app/picture/camera_motion.h"
#include "app/picture/view_of_bodies.h"
#include "app/world/simulation.h"
#include "render/frame/frame.h"
#include "scenes/loader/scene.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// What may be called on the way to a camera, on the thread that asks for it. Either may throw.
struct CameraEvents {
  /// A frame has been simulated ahead, of those up to the time `until`, s.
  std::function<void(const sim::World& ahead, double until)> looked_ahead = {};
  /// What the user should know.
  std::function<void(const std::string& text)> notice = {};
};

/// The scene's own camera, as it moves, or one that has all bodies in view, above the caption, and
/// moves away only when they come to go further.
///
/// For the latter the run is simulated ahead, but for `look_ahead` only, so that no frame waits for
/// more. Let E(k) be the nearest camera that sees all of frames 0..k, where k is at least the
/// look-ahead, L: then frame f has the mean of E(f), ..., E(f + L). It sees all of frames 0..f: a
/// camera sees a point if it is on one side of four planes, and so is the mean of such cameras. It
/// starts to move before a body would leave the picture, and without jerks: its speed changes in a
/// frame by no more than 2 / (L + 1) of the fastest E. A run that is no longer than the look-ahead
/// has a still camera.
///
/// A function of the run's states alone: it is the same for every number of threads, whatever part
/// of the run is drawn, and after a resume. A run that diverges counts up to there.
class RunCamera {
 public:
  /// s of the scene's time. A body falls 20 m in it: in most scenes what falls has landed by then,
  /// and the camera stays where it is.
  static constexpr double look_ahead = 2.0;

  /// `start`: the scene's world at its start.
  RunCamera(const scenes::Scene& scene, const sim::World& start, int threads,
            OnDivergence on_divergence = OnDivergence::automatic, CameraEvents events = {});

  /// To be told of every frame that is not asked for, in its turn.
  void see(const sim::World& world);
  /// Of an automatic camera, what has been seen so far: a run that is continued goes on with it.
  std::optional<render::ViewFit::Seen> seen() const;
  void go_on(const render::ViewFit::Seen& seen);

  /// The camera of the frame that shows `world`, or of the one before. Frames are asked for in
  /// their order.
  render::Camera at(const sim::World& world);
  /// Simulates ahead for the next frame while the caller goes on with something else.
  void prepare_next();

  /// From now on frames that are simulated ahead are kept, until they take more than `most_bytes`,
  /// for one who takes each of them in place of simulating it again.
  void keep_frames(std::size_t most_bytes = std::size_t{512} << 20);
  /// None if that frame has not been kept. Frames before it are forgotten.
  std::optional<SimulatedFrame> take_frame(std::int64_t frame);

  /// From now on the camera has all of the run in view that starts here.
  void look_to_the_end(const sim::World& start);

 private:
  bool is_automatic() const { return view_.has_value(); }
  std::int64_t frame_of(const sim::World& world) const { return world.steps / steps_per_frame_; }
  bool shows_frame(const sim::World& world) const { return world.steps % steps_per_frame_ == 0; }
  void start_ahead(const sim::World& world);
  void advance_ahead();
  void advance_ahead_to(std::int64_t frame);
  void keep_frame();
  void forget_frames();
  const render::Camera& camera_of(std::int64_t frame) const;
  render::Camera mean_camera() const;
  void say_what_is_new();
  void say(const std::string& text) const;

  scenes::Scene scene_;
  int threads_;
  OnDivergence on_divergence_;
  CameraEvents events_;
  int steps_per_frame_;
  std::int64_t last_frame_;
  std::int64_t frames_ahead_;
  CameraMotion motion_;
  render::Camera fixed_;                 // unless it is automatic
  std::optional<render::Camera> whole_;  // of look_to_the_end
  std::optional<ViewOfBodies> view_;     // of the run so far; none: the camera is not automatic
  std::int64_t frame_ = 0;               // the last that was asked for

  std::optional<Simulation> ahead_;
  std::optional<ViewOfBodies> view_ahead_;
  bool ahead_has_ended_ = false;        // by a divergence
  std::deque<render::Camera> cameras_;  // E(k) above
  std::int64_t last_camera_ = 0;        // the k of the last of them
  bool gives_frames_ = false;           // as far as who takes them knows, without a wait
  bool keeps_frames_ = false;
  std::size_t most_bytes_kept_ = 0, bytes_kept_ = 0;
  std::deque<SimulatedFrame> kept_;  // from one frame to the last that was simulated ahead

  std::string beyond_;  // that a body goes too far
  bool beyond_said_ = false;
  bool wait_said_ = false;
  std::optional<Background> looking_;  // the last member: it ends before what its jobs use
};

}  // namespace pneuma::app
