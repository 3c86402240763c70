#include "app/picture/run_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/host/clock.h"
#include "app/host/errors.h"
#include "app/picture/place_camera.h"

namespace pneuma::app {
namespace {

std::string goes_beyond(const std::string& body, double time) {
  return fmt::format(
      "body '{}' goes beyond the automatic camera's view at t = {:.2f} s: to have it in view the "
      "camera would be too far away to show anything; give eye and target in [camera], or follow = "
      "\"{}\"",
      body, time, body);
}

template <typename Value>
std::size_t bytes_of(const std::vector<Value>& values) {
  return values.size() * sizeof(Value);
}

/// But for names and settings, which are little, and meshes, which all frames share.
std::size_t bytes_of(const SimulatedFrame& frame) {
  const sim::World& world = frame.world;
  std::size_t bytes = bytes_of(frame.contacts) + bytes_of(frame.step_parts) + bytes_of(world.soft) +
                      bytes_of(world.rigid) + bytes_of(world.rest) +
                      bytes_of(world.warm_start_impulses) + bytes_of(world.feature_impulses) +
                      bytes_of(world.friction_slips) + bytes_of(world.depenetrating) +
                      bytes_of(world.lost_energy);
  for (const sim::SoftBody& body : world.soft) {
    const auto numbers = body.positions.rows().size() + body.velocities.rows().size();
    bytes += static_cast<std::size_t>(numbers) * sizeof(double);
  }
  for (const sim::ParticlePair& pair : world.particles) {
    bytes += sizeof pair + bytes_of(pair.first_features) + bytes_of(pair.second_features);
  }
  return bytes;
}

/// Sums in the order of frames, so that every run comes to the same.
class MeanCamera {
 public:
  void add(const render::Camera& camera) {
    eye_ += camera.eye.cast<double>();
    target_ += camera.target.cast<double>();
    field_of_view_ = camera.field_of_view;
    ++count_;
  }

  render::Camera mean() const {
    const auto count = static_cast<double>(count_);
    return {(eye_ / count).cast<float>(), (target_ / count).cast<float>(), field_of_view_};
  }

 private:
  sim::Vec3 eye_ = sim::Vec3::Zero();
  sim::Vec3 target_ = sim::Vec3::Zero();
  float field_of_view_ = 0.0f;
  int count_ = 0;
};

}  // namespace

RunCamera::RunCamera(const scenes::Scene& scene, const sim::World& start, int threads,
                     OnDivergence on_divergence, CameraEvents events)
    : scene_(scene),
      threads_(threads),
      on_divergence_(on_divergence),
      events_(std::move(events)),
      steps_per_frame_(scenes::steps_per_frame(scene)),
      last_frame_(scenes::frame_count(scene)),
      frames_ahead_(
          std::max<std::int64_t>(1, std::llround(look_ahead * scene.picture.frames_per_second))),
      motion_(scene, start) {
  if (is_left_to_program(scene.camera)) {
    view_.emplace(scene, start).add(start);
  } else {
    fixed_ = placed_camera(scene, start);
    say(what_camera_misses(scene, start));
  }
}

void RunCamera::see(const sim::World& world) {
  if (is_automatic() && shows_frame(world)) view_->add(world);
}

std::optional<render::ViewFit::Seen> RunCamera::seen() const {
  if (!is_automatic()) return std::nullopt;
  return view_->seen();
}

void RunCamera::go_on(const render::ViewFit::Seen& seen) {
  if (is_automatic()) view_->include(seen);
}

render::Camera RunCamera::at(const sim::World& world) {
  if (!is_automatic()) return motion_.at(fixed_, world);
  if (whole_) return motion_.at(*whole_, world);
  see(world);
  if (looking_) looking_->finish();
  frame_ = frame_of(world);
  if (frame_ > last_frame_) return motion_.at(view_->camera(), world);
  if (!ahead_ || last_camera_ < frame_) start_ahead(world);
  advance_ahead_to(frame_ + frames_ahead_);
  say_what_is_new();
  while (last_camera_ - static_cast<std::int64_t>(cameras_.size()) + 1 < frame_) {
    cameras_.pop_front();
  }
  return motion_.at(mean_camera(), world);
}

void RunCamera::prepare_next() {
  if (!ahead_ || whole_) return;
  if (!looking_) looking_.emplace(1);
  looking_->submit([this] {
    if (last_camera_ < frame_ + 1 + frames_ahead_) advance_ahead();
  });
}

void RunCamera::look_to_the_end(const sim::World& start) {
  if (!is_automatic()) return;
  start_ahead(start);
  advance_ahead_to(last_frame_);
  whole_ = cameras_.back();
}

void RunCamera::keep_frames(std::size_t most_bytes) {
  keeps_frames_ = gives_frames_ = true;
  most_bytes_kept_ = most_bytes;
}

std::optional<SimulatedFrame> RunCamera::take_frame(std::int64_t frame) {
  if (gives_frames_ && looking_) looking_->finish();
  gives_frames_ = gives_frames_ && keeps_frames_;
  if (!gives_frames_) return std::nullopt;
  std::optional<SimulatedFrame> taken;
  while (!kept_.empty() && frame_of(kept_.front().world) <= frame) {
    bytes_kept_ -= bytes_of(kept_.front());
    taken = std::move(kept_.front());
    kept_.pop_front();
  }
  if (taken && frame_of(taken->world) != frame) return std::nullopt;
  return taken;
}

/// From the run's own state, so that what it has done already is not simulated again.
void RunCamera::start_ahead(const sim::World& world) {
  ahead_.emplace(scene_, world, threads_, on_divergence_);
  ahead_has_ended_ = false;
  view_ahead_ = view_;
  cameras_ = {view_->camera()};
  last_camera_ = frame_of(world);
  forget_frames();
}

/// Frames and not steps: what lies between two pictures is seen by nobody.
void RunCamera::advance_ahead() {
  if (ahead_has_ended_ || last_camera_ >= last_frame_) return;
  try {
    ahead_->advance_frame();
  } catch (const DivergenceError&) {
    ahead_has_ended_ = true;  // the run itself will come to the same step and report it
    return;
  }
  const auto body = view_ahead_->add(ahead_->world());
  if (body && beyond_.empty()) beyond_ = goes_beyond(*body, sim::time(ahead_->world()));
  cameras_.push_back(view_ahead_->camera());
  ++last_camera_;
  if (keeps_frames_) keep_frame();
}

void RunCamera::keep_frame() {
  kept_.push_back(ahead_->present_frame());
  bytes_kept_ += bytes_of(kept_.back());
  if (bytes_kept_ <= most_bytes_kept_) return;
  keeps_frames_ = false;
  forget_frames();
}

void RunCamera::forget_frames() {
  kept_.clear();
  bytes_kept_ = 0;
}

void RunCamera::advance_ahead_to(std::int64_t frame) {
  const std::int64_t last = std::min(frame, last_frame_);
  const double until = static_cast<double>(last) / scene_.picture.frames_per_second;
  const Clock::time_point begin = Clock::now();
  while (!ahead_has_ended_ && last_camera_ < last) {
    advance_ahead();
    if (events_.looked_ahead) events_.looked_ahead(ahead_->world(), until);
  }
  constexpr double worth_a_word = 5.0;  // s
  const double seconds = seconds_since(begin);
  if (seconds < worth_a_word || wait_said_) return;
  wait_said_ = true;
  say(fmt::format(
      "looking ahead for the camera took {:.0f} s; eye and target in [camera] save the wait",
      seconds));
}

/// E(k) as far as the simulation ahead has come.
const render::Camera& RunCamera::camera_of(std::int64_t k) const {
  const std::int64_t back = std::max<std::int64_t>(0, last_camera_ - std::max(k, frames_ahead_));
  return cameras_[cameras_.size() - 1 - static_cast<std::size_t>(back)];
}

render::Camera RunCamera::mean_camera() const {
  MeanCamera mean;
  for (std::int64_t k = frame_; k <= frame_ + frames_ahead_; ++k) mean.add(camera_of(k));
  return mean.mean();
}

void RunCamera::say_what_is_new() {
  if (beyond_.empty() || beyond_said_) return;
  beyond_said_ = true;
  say(beyond_);
}

void RunCamera::say(const std::string& text) const {
  if (!text.empty() && events_.notice) events_.notice(text);
}

}  // namespace pneuma::app
