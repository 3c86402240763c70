#include "app/study/stability/contact_stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/host/errors.h"
#include "app/host/interrupt.h"
#include "app/study/stability/stability_study.h"
#include "sim/mesh/measure.h"
#include "sim/potential/explicit_world_step.h"
#include "sim/potential/world_vibration.h"
#include "sim/step/stepper.h"

namespace pneuma::app {
namespace {

using sim::Integrator;

/// It falls and is held up; then, time and again, its motion is taken and it goes on towards rest.
constexpr int settling_rate = 60;  // steps/s
constexpr int falling_steps = 600;
constexpr int rests = 60;
constexpr int steps_between_rests = 15;
/// Of a plate: its thickness over its width, so that it lies on a ball without tipping.
constexpr double plate_thickness = 0.1;

constexpr double moved_by = 1e-9;  // m
/// Times that: what grows by 0.6 % a step. What has no friction to hold it rolls over slowly, by a
/// factor e in some seconds, and takes longer to part.
constexpr double parted_by = 10.0;
constexpr int steps_to_part = 400;
constexpr double step_precision = 1.01;
constexpr double search_factor = 1.1;
constexpr double widest_search = 4.0;  // of what is predicted, and its inverse

/// A world's equation in steps that nothing divides.
class RawSteps {
 public:
  explicit RawSteps(const sim::World& at_rest)
      : surfaces_(at_rest),
        acceleration_(at_rest, surfaces_, sim::box_form_for(at_rest.settings.integrator)),
        integrator_(at_rest.settings.integrator),
        memory_(surfaces_.vertex_count(), integrator_),
        rest_{sim::VertexArray(surfaces_.vertex_count()),
              sim::VertexArray(surfaces_.vertex_count())},
        next_(rest_) {
    surfaces_.gather(at_rest, rest_.positions, rest_.velocities);
    surfaces_.place_boxes(at_rest, rest_.positions);
    std::vector<sim::RigidState> boxes;
    for (const sim::RigidBox& box : at_rest.rigid) {
      if (!box.is_kinematic) boxes.push_back(sim::state_of(box));
    }
    acceleration_.start_boxes(boxes, rest_.positions, rest_.velocities);
    acceleration_.set_margin(0.5 * surfaces_[0].reach);
  }

  /// Whether motions part that begin next to each other: from rest and beside it. Both are
  /// followed, since what is almost at rest still comes to rest.
  bool part(double step) {
    sim::SoftState one = rest_, other = rest_;
    for (int v = 0; v < surfaces_[0].vertex_count; ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        other.positions[v][axis] += moved_by * std::sin(1.0 + 3 * v + axis);
      }
    }
    const auto distance = [&] { return (one.positions.rows() - other.positions.rows()).norm(); };
    const double start = distance();
    for (int i = 0; i < steps_to_part; ++i) {
      throw_if_interrupted();
      advance(step, one);
      advance(step, other);
      if (!(distance() < parted_by * start)) return true;
    }
    return false;
  }

 private:
  void advance(double step, sim::SoftState& state) {
    sim::explicit_step(integrator_, acceleration_, step, state, next_.positions, next_.velocities,
                       memory_);
    std::swap(state, next_);
  }

  sim::ContactSurfaces surfaces_;
  sim::WorldAcceleration acceleration_;
  Integrator integrator_;
  sim::ExplicitScratch memory_;
  sim::SoftState rest_, next_;
};

OwnSteps try_own_steps(sim::World world, int rate, double seconds) {
  world.settings.steps_per_second = rate;
  sim::SoftBody& body = world.soft.front();
  disturb(body);
  OwnSteps own{rate};
  std::int64_t parts = 0;
  sim::StepperOptions options;
  options.after_part = [&](const sim::World&) { ++parts; };
  sim::Stepper stepper(world, std::move(options));
  const auto steps = static_cast<std::int64_t>(seconds * rate);
  for (std::int64_t i = 0; i < steps; ++i) {
    throw_if_interrupted();
    if (const auto divergence = stepper.step(world)) {
      own.failure = fmt::format("step {}: {}", divergence->step, divergence->what);
      break;
    }
    if (2 * i < steps) continue;
    const double fastest = std::sqrt(body.velocities.rows().colwise().squaredNorm().maxCoeff());
    own.trembling = std::max(own.trembling, fastest);
  }
  own.parts =
      static_cast<double>(parts) / static_cast<double>(std::max<std::int64_t>(world.steps, 1));
  return own;
}

void take_motion(sim::World& world) {
  for (sim::SoftBody& body : world.soft) body.velocities.rows().setZero();
  for (sim::RigidBox& box : world.rigid) {
    box.velocity.setZero();
    box.angular_velocity.setZero();
  }
}

/// Throws UsageError when it diverges.
void let_settle(sim::World& world) {
  world.settings.integrator = Integrator::implicit_euler;
  world.settings.steps_per_second = settling_rate;
  sim::Stepper stepper(world);
  for (int i = 0; i < falling_steps + rests * steps_between_rests; ++i) {
    throw_if_interrupted();
    if (const auto divergence = stepper.step(world)) {
      throw UsageError(fmt::format(
          "{} does not come to rest on the ground: step {}: {}; study another scene, or this one "
          "with other values (--set)",
          world.soft.front().name, divergence->step, divergence->what));
    }
    if (i >= falling_steps && i % steps_between_rests == 0) take_motion(world);
  }
  world.steps = 0;
  take_motion(world);
}

sim::World without_restitution_loss(sim::World world) {
  world.settings.ground->restitution = 1.0;
  for (sim::SoftBody& body : world.soft) body.material.surface.restitution = 1.0;
  for (sim::RigidBox& box : world.rigid) box.surface.restitution = 1.0;
  return world;
}

sim::RigidBox plate_on(const sim::SoftBody& body, double gap, double mass_ratio,
                       const sim::ContactMaterial& surface) {
  const sim::Bounds bounds = sim::bounds(body.positions);
  const double width = bounds.size().head<2>().maxCoeff();
  const double mass = mass_ratio * body.material.vertex_mass * body.positions.size();
  const double height = plate_thickness * width;
  const sim::Vec3 middle = 0.5 * (bounds.low + bounds.high);
  sim::RigidBox plate;
  plate.name = "plate";
  plate.size = {width, width, height};
  plate.position = {middle.x(), middle.y(), bounds.high.z() + gap + 0.5 * height};
  plate.mass = mass;
  plate.surface = surface;
  return plate;
}

}  // namespace

sim::World lying_body(const sim::Settings& settings, sim::SoftBody body, double stiffness,
                      double friction, double mass_ratio) {
  sim::World world;
  world.settings = settings;
  world.settings.contact = sim::ContactMethod::potential;
  world.settings.gravity = {0.0, 0.0, -9.81};
  body.material.pressure_weighting = sim::PressureWeighting::uniform;
  body.material.damping = sim::Damping::dashpot;
  body.material.surface.friction = friction;
  world.settings.ground = body.material.surface;
  body.velocities.rows().setZero();
  body.positions.rows().row(2).array() -= body.positions.rows().row(2).minCoeff();
  body.pins.reset();
  const double gap = 1.01 * settings.potential.distance;
  if (mass_ratio > 0.0) {
    world.rigid.push_back(plate_on(body, gap, mass_ratio, body.material.surface));
  }
  world.soft.push_back(std::move(body));
  world.settings.potential.stiffness = stiffness * sim::ContactSurfaces(world).stiffness();
  let_settle(world);
  return world;
}

std::optional<double> find_stable_contact_step(const sim::World& at_rest, double predicted) {
  RawSteps steps(at_rest);
  // From below: far beyond the limit it trembles at once, and differences grow no more.
  double high = predicted / widest_search;
  if (steps.part(high)) return {};
  while (!steps.part(high *= search_factor)) {
    if (high > widest_search * predicted) return {};
  }
  double low = high / search_factor;
  while (high > step_precision * low) {
    const double middle = std::sqrt(low * high);
    (steps.part(middle) ? high : low) = middle;
  }
  return low;
}

ContactStabilityOptions full_contact_sweep() {
  return {.stiffness = {1e-2, 1.0, 1e2, 1e4},
          .friction = {0.01, 0.1, 1.0},
          .mass_ratio = {1e-2, 1.0, 1e2, 1e3},
          .rates = {60, 960},
          .seconds = 2.0};
}

ContactStabilityOptions short_contact_sweep() {
  return {.stiffness = {1.0, 1e2},
          .friction = {0.0},
          .mass_ratio = {1.0},
          .rates = {60},
          .seconds = 1.0};
}

std::vector<ContactStabilityPoint> study_contact_stability(
    const scenes::Scene& scene, const ContactStabilityOptions& options,
    const std::function<void(const std::string&)>& say) {
  const sim::SoftBody body = first_soft_body(scene);
  const double friction = body.material.surface.friction;
  std::vector<ContactStabilityPoint> points;
  const auto add = [&](const std::string& varied, double value, sim::World world) {
    sim::World without_loss = without_restitution_loss(world);
    sim::WorldVibration motions(without_loss);
    for (const Integrator integrator : integrators_of(scene)) {
      say(fmt::format("{}, {} = {:g}", integrator_name(integrator), varied, value));
      ContactStabilityPoint point{integrator, varied, value};
      world.settings.integrator = without_loss.settings.integrator = integrator;
      const double predicted = sim::stability_limit(motions, integrator).step;
      if (std::isfinite(predicted)) {
        point.predicted_step = predicted;
        point.stable_step = find_stable_contact_step(without_loss, predicted);
      }
      for (const int rate : options.rates) {
        point.own.push_back(try_own_steps(world, rate, options.seconds));
      }
      points.push_back(std::move(point));
    }
  };
  for (const double stiffness : options.stiffness) {
    add("contact stiffness", stiffness, lying_body(scene.settings, body, stiffness, friction, 0.0));
  }
  for (const double other : options.friction) {
    add("friction", other, lying_body(scene.settings, body, 1.0, other, 0.0));
  }
  for (const double ratio : options.mass_ratio) {
    add("mass ratio", ratio, lying_body(scene.settings, body, 1.0, friction, ratio));
  }
  return points;
}

}  // namespace pneuma::app
