#include "app/study/impact/impact_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "app/world/start_overlap.h"
#include "app/world/step_advice.h"
#include "scenes/loader/load_scene.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "sim/inspect/triangle_tree.h"
#include "sim/mesh/measure.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

constexpr int max_doublings = 4;
/// Of the thinnest body: further it does not get from one look to the next.
constexpr double look_every = 0.5;

/// Looks for crossings on the ways of the surfaces between the states that it is shown.
class CrossingWatch {
 public:
  explicit CrossingWatch(const sim::World& world) : last_(sim::closed_surfaces(world)) {
    for (const sim::SoftBody& body : world.soft) add(sim::bounds(body.positions).size());
    for (const sim::RigidBox& box : world.rigid) add(box.size);
  }

  void look(const sim::World& world) {
    std::vector<sim::ClosedSurface> next = sim::closed_surfaces(world);
    if (!may_cross(next)) {
      last_ = std::move(next);
      return;
    }
    const int looks = static_cast<int>(std::ceil(greatest_way(next) / look_after_)) + 1;
    for (int i = 1; i <= looks && !have_crossed_; ++i) {
      const auto between = after(static_cast<double>(i) / looks, next);
      have_crossed_ = sim::crossings(between, 0).between_bodies > 0;
    }
    last_ = std::move(next);
  }

  bool have_crossed() const { return have_crossed_; }

 private:
  void add(const Vec3& size) { look_after_ = std::min(look_after_, look_every * size.minCoeff()); }

  /// Whether boxes about the ways of two bodies meet.
  bool may_cross(const std::vector<sim::ClosedSurface>& next) const {
    std::vector<sim::Extent> ways(next.size());
    for (std::size_t body = 0; body < next.size(); ++body) {
      for (const base::Point& point : last_[body].points) ways[body].include(point);
      for (const base::Point& point : next[body].points) ways[body].include(point);
    }
    for (std::size_t i = 0; i < ways.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (ways[i].meets(ways[j])) return true;
      }
    }
    return false;
  }

  /// m, of two bodies against each other.
  double greatest_way(const std::vector<sim::ClosedSurface>& next) const {
    double greatest = 0.0;
    for (std::size_t body = 0; body < next.size(); ++body) {
      for (std::size_t v = 0; v < next[body].points.size(); ++v) {
        const base::Point &from = last_[body].points[v], &to = next[body].points[v];
        greatest =
            std::max(greatest, std::hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]));
      }
    }
    return 2.0 * greatest;
  }

  std::vector<sim::ClosedSurface> after(double share,
                                        const std::vector<sim::ClosedSurface>& next) const {
    std::vector<sim::ClosedSurface> between = next;
    for (std::size_t body = 0; body < next.size(); ++body) {
      for (std::size_t v = 0; v < next[body].points.size(); ++v) {
        for (std::size_t k = 0; k < 3; ++k) {
          between[body].points[v][k] =
              std::lerp(last_[body].points[v][k], next[body].points[v][k], share);
        }
      }
    }
    return between;
  }

  std::vector<sim::ClosedSurface> last_;
  double look_after_ = std::numeric_limits<double>::infinity();  // m
  bool have_crossed_ = false;
};

bool has_lost_a_volume(const sim::World& world) {
  return std::ranges::any_of(world.soft, [](const sim::SoftBody& body) {
    return !(sim::volume(body.mesh->topology, body.positions) > 0.0);
  });
}

/// As many steps as the springs bear, and the gas that will blow the body up.
void shorten_steps(sim::World& world) {
  for (const StepAdvice& advice : step_advices(world)) {
    if (!advice.too_long()) continue;
    world.settings.steps_per_second =
        std::max(world.settings.steps_per_second, advice.steps_per_second);
  }
}

/// Whether it came to an end: false if a step failed for another reason than contacts, which a
/// shorter one may bear.
bool run(const RandomImpact& impact, sim::World world, const std::string& name,
         ImpactResult& result) {
  const double kinetic = sim::energy(world).kinetic;
  const auto steps =
      static_cast<std::int64_t>(std::ceil(impact.seconds * world.settings.steps_per_second));
  CrossingWatch watch(world);
  sim::Stepper stepper(world, {.measure_work = true,
                               .plan = {},
                               .after_part = [&](const sim::World& part) { watch.look(part); }});
  result = {.outcome = ImpactOutcome::missed,
            .message = "",
            .steps_per_second = world.settings.steps_per_second};
  while (world.steps < steps) {
    const auto divergence = stepper.step(world);
    result.seconds = sim::time(world);
    if (divergence) {
      result.outcome = ImpactOutcome::stopped;
      result.message = divergence_error(name, *divergence, world).what();
      return divergence->stage == sim::Stage::resolve_contacts;
    }
    if (!stepper.contacts().empty()) result.outcome = ImpactOutcome::held;
    result.most_work = std::max(result.most_work, stepper.contact_work() / kinetic);
    if (watch.have_crossed()) {
      result.outcome = ImpactOutcome::crossed;
      result.message = fmt::format("the bodies cross in step {}", world.steps);
      return true;
    }
    if (has_lost_a_volume(world)) {
      result.outcome = ImpactOutcome::no_volume;
      result.message = fmt::format("a body has no volume after step {}", world.steps);
      return true;
    }
  }
  return true;
}

}  // namespace

ImpactResult run_impact(const RandomImpact& impact) {
  ImpactResult result;
  try {
    const scenes::Scene scene = scenes::parse_scene(impact.scene, "impact.toml");
    sim::World start = build_world(scene);
    refuse_start_overlap(scene, start);
    shorten_steps(start);
    for (int i = 0; i <= max_doublings && !run(impact, start, scene.name, result); ++i) {
      start.settings.steps_per_second *= 2;
    }
  } catch (const scenes::SceneError& error) {
    result.outcome = ImpactOutcome::refused;
    result.message = error.what();
  }
  return result;
}

}  // namespace pneuma::app
