#include "app/render/run_notices.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/record/pressed_volume.h"
#include "app/terminal/table.h"
#include "app/world/may_start.h"
#include "render/frame/camera.h"
#include "sim/collision/oriented_box.h"
#include "sim/collision/point_in_body.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {

void DividedSteps::add(const Simulation& simulation, Progress& progress) {
  const std::vector<int>& parts = simulation.step_parts();
  if (parts.empty()) return;
  if (count_ == 0) {
    progress.say(fmt::format("a step before t = {:.4f} s diverged; it was done again in {} parts",
                             sim::time(simulation.world()), parts.front()));
  }
  count_ += static_cast<std::int64_t>(parts.size());
  most_ = std::max(most_, *std::max_element(parts.begin(), parts.end()));
}

void DividedSteps::summarise(Progress& progress) const {
  if (count_ == 0) return;
  progress.say(fmt::format("{} diverged and {} done in parts, up to {} of them",
                           count_ == 1 ? "1 step" : fmt::format("{} steps", count_),
                           count_ == 1 ? "was" : "were", most_));
}

void CrossedFrames::add(const Simulation& simulation, const FrameState& state, Progress& progress) {
  ++frames_;
  if (!state.crosses_itself.empty() && of_themselves_++ == 0) {
    itself_ = state.crosses_itself;
    may_use_potential_ = may_use_potential(simulation.scene(), "sdirk2");
  }
  if (state.bodies_that_cross.empty()) return;
  if (count_++ > 0) return;
  const bool is_swept = simulation.world().settings.contact != sim::ContactMethod::impulses;
  progress.say(fmt::format("{} pass through each other at t = {:.2f} s{}", state.bodies_that_cross,
                           sim::time(simulation.world()),
                           is_swept ? "" : "; simulation.contact = \"swept\" keeps bodies apart"));
}

void CrossedFrames::summarise(Progress& progress, bool is_resumed) const {
  const std::string frames = is_resumed ? fmt::format("the {} drawn now", counted(frames_, "frame"))
                                        : counted(frames_, "frame");
  if (count_ > 0) {
    progress.say(fmt::format("bodies pass through each other in {} of {}", count_, frames));
  }
  if (of_themselves_ > 0) {
    progress.say(
        fmt::format("{} passes through itself in {} of {}; bending of the body makes that rarer{}",
                    itself_, of_themselves_, frames,
                    may_use_potential_
                        ? ", and simulation.contact = \"potential\" with simulation.integrator = "
                          "\"sdirk2\" rules it out, for several times the time"
                        : ""));
  }
}

void PressedBodies::add(const sim::World& world) {
  if (shapes_.empty()) {
    for (const sim::SoftBody& body : world.soft) {
      shapes_.push_back(sim::volume(body.mesh->topology, body.mesh->rest_positions));
    }
  }
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const sim::SoftBody& body = world.soft[i];
    if (!keeps_gas(world, static_cast<int>(i)) || shapes_[i] <= 0.0) continue;
    const double volume = std::max(0.0, sim::volume(body.mesh->topology, body.positions));
    if (volume / shapes_[i] >= least_fraction_) continue;
    least_fraction_ = volume / shapes_[i];
    time_ = sim::time(world);
    body_ = body.name;
  }
}

void PressedBodies::summarise(Progress& progress) const {
  if (least_fraction_ >= pressed_fraction) return;
  progress.say(fmt::format(
      "body '{}' was pressed to {:.2g} % of its shape's volume, at t = {:.2f} s: more gas (n, "
      "gauge_pressure) carries more, and what closes in on it can leave it more room",
      body_, 100.0 * least_fraction_, time_));
}

namespace {

/// Which sides of a picture all points of a body are beyond: where there is one, the body is not in
/// the picture.
class BeyondSides {
 public:
  BeyondSides(const render::Camera& camera, double aspect)
      // Sides do not depend on how near and how far the camera sees.
      : clip_(render::projection_matrix(camera.field_of_view, static_cast<float>(aspect), 1.0f,
                                        2.0f) *
              render::view_matrix(camera)) {}

  void add(const sim::Vec3& point) {
    const Eigen::Vector4f seen = clip_ * point.cast<float>().homogeneous();
    const float x = seen.x(), y = seen.y(), w = seen.w();
    const std::array beyond{x > w, -x > w, y > w, -y > w, w <= 0.0f};
    for (std::size_t side = 0; side < beyond.size(); ++side) all_[side] &= beyond[side];
  }
  bool any() const { return std::ranges::find(all_, true) != all_.end(); }

 private:
  render::Mat4f clip_;
  std::array<bool, 5> all_{true, true, true, true, true};  // the last: behind the camera
};

bool may_be_seen(const sim::World& world, int body, BeyondSides beyond) {
  const std::size_t i = sim::at(body), soft = world.soft.size();
  if (i < soft) {
    for (int v = 0; v < world.soft[i].positions.size(); ++v) {
      beyond.add(world.soft[i].positions[v]);
    }
  } else {
    const sim::RigidBox& box = world.rigid[i - soft];
    const sim::Mat3 axes = box.orientation.toRotationMatrix();
    for (const sim::Vec3& corner : sim::corners({box.position, axes, 0.5 * box.size})) {
      beyond.add(corner);
    }
  }
  return !beyond.any();
}

}  // namespace

void UnseenFrames::add(const sim::World& world, const render::Camera& camera, double aspect) {
  bool any = false, any_seen = false;
  for (int body = 0; body < sim::body_count(world) && !any_seen; ++body) {
    if (sim::is_kinematic(world, body)) continue;
    any = true;
    any_seen = may_be_seen(world, body, BeyondSides(camera, aspect));
  }
  if (!any) return;
  ++frames_;
  if (!any_seen) ++empty_;
  const sim::Vec3 eye = camera.eye.cast<double>();
  const auto holds_eye = [&](const sim::SoftBody& body) {
    return sim::is_inside({body.mesh->topology, body.positions}, eye);
  };
  const auto holder = std::ranges::find_if(world.soft, holds_eye);
  if (holder == world.soft.end()) return;
  if (inside_++ == 0) body_ = holder->name;
}

void UnseenFrames::summarise(Progress& progress) const {
  constexpr const char* remedy =
      "without [camera] eye and target, or with camera.follow, the camera goes where bodies are";
  if (empty_ > 0) {
    progress.say(fmt::format("no body that may move is in the picture in {} of {}; {}", empty_,
                             counted(frames_, "frame"), remedy));
  }
  if (inside_ > 0) {
    progress.say(fmt::format("the camera is inside of body '{}' in {} of {}; {}", body_, inside_,
                             counted(frames_, "frame"), remedy));
  }
}

}  // namespace pneuma::app
