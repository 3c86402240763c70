#include "app/study/extreme/extreme_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "app/host/interrupt.h"
#include "app/world/build_world.h"
#include "app/world/simulation.h"
#include "scenes/loader/load_scene.h"
#include "sim/base/enum_name.h"
#include "sim/inspect/crossings.h"
#include "sim/inspect/inspect.h"
#include "sim/mesh/measure.h"
#include "sim/soft/pressure_force.h"

namespace pneuma::app {
namespace {

using sim::Vec3;

void scatter(sim::SoftBody& body) {
  // Half the extent either way; a fixed seed, so that the case is the same everywhere.
  const Vec3 half = 0.5 * sim::bounds(body.positions).size();
  std::mt19937_64 random(1);
  for (int v = 0; v < body.positions.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      const double share = static_cast<double>(random() >> 11) * 0x1.0p-52 - 1.0;  // -1..1
      body.positions[v][axis] += share * half[axis];
    }
  }
}

void prepare(sim::SoftBody& body, ExtremeStart start) {
  const sim::Bounds box = sim::bounds(body.positions);
  const Vec3 centre = box.centre();
  switch (start) {
    case ExtremeStart::as_made:
      break;
    case ExtremeStart::flat:
      for (int v = 0; v < body.positions.size(); ++v) body.positions[v].z() = box.low.z();
      break;
    case ExtremeStart::inside_out:
      for (int v = 0; v < body.positions.size(); ++v) {
        body.positions[v].x() = 2.0 * centre.x() - body.positions[v].x();
      }
      break;
    case ExtremeStart::scattered:
      scatter(body);
      break;
    case ExtremeStart::one_point:
      for (int v = 0; v < body.positions.size(); ++v) body.positions[v] = centre;
      break;
  }
}

double volume_of(const sim::SoftBody& body) {
  return sim::volume(body.mesh->topology, body.positions);
}

double fastest(const sim::World& world) {
  double squared = 0.0;
  for (const sim::SoftBody& body : world.soft) {
    squared = std::max(squared, body.velocities.rows().colwise().squaredNorm().maxCoeff());
  }
  for (const sim::RigidBox& box : world.rigid) {
    squared = std::max(squared, box.velocity.squaredNorm());
  }
  return std::sqrt(squared);
}

/// Looks at a world now and then while it runs.
class Watch {
 public:
  Watch(const sim::World& world, Crossing may_not_cross, ExtremeResult& result)
      : may_not_cross_(may_not_cross), result_(result) {
    start_energy_ = least_energy_ = greatest_energy_ = sim::energy(world).total();
    for (const sim::SoftBody& body : world.soft) start_volumes_.push_back(volume_of(body));
  }

  void look(const sim::World& world, bool penetration_counts) {
    const double energy = sim::energy(world).total();
    if (!std::isfinite(energy)) return fail("the energy is not a finite number");
    least_energy_ = std::min(least_energy_, energy);
    greatest_energy_ = std::max(greatest_energy_, energy);
    result_.greatest_speed = std::max(result_.greatest_speed, fastest(world));
    if (!std::isfinite(result_.greatest_speed)) return fail("a speed is not a finite number");
    for (std::size_t i = 0; i < world.soft.size(); ++i) {
      if (sim::gas_strength(world.soft[i].material) == 0.0) continue;
      const double volume = volume_of(world.soft[i]);
      if (!(volume > 0.0)) return fail("a volume is not above zero");
      result_.least_volume_share = std::min(result_.least_volume_share, volume / start_volumes_[i]);
    }
    if (may_not_cross_ != Crossing::looked_for_nowhere) look_for_crossings(world);
    if (penetration_counts) {
      result_.penetration = std::max(result_.penetration, sim::max_penetration(world));
    }
  }

  void finish(const ExtremeCase& extreme) {
    result_.energy_gain = greatest_energy_ - start_energy_;
    result_.energy_span = greatest_energy_ - least_energy_;
    if (result_.energy_gain > extreme.energy_tolerance * result_.energy_span) {
      fail(fmt::format("the energy rose {:.3g} J above its start", result_.energy_gain));
    }
    if (result_.penetration > extreme.penetration) {
      fail(fmt::format("bodies reach {:.3g} m into each other", result_.penetration));
    }
  }

 private:
  void look_for_crossings(const sim::World& world) {
    const sim::Crossings found = sim::crossings(world);
    if (found.between_bodies > 0) return fail("bodies pass through each other");
    if (may_not_cross_ == Crossing::of_any_surface && found.within_bodies > 0) {
      return fail("a body passes through itself");
    }
  }

  void fail(const std::string& why) {
    result_.valid = false;
    if (result_.message.empty()) result_.message = why;
  }

  Crossing may_not_cross_;
  ExtremeResult& result_;
  double start_energy_ = 0.0, least_energy_ = 0.0, greatest_energy_ = 0.0;
  std::vector<double> start_volumes_;
};

/// Steps from one look to the next: every one in a short run, a few hundred in a long one.
std::int64_t steps_per_look(std::int64_t steps) { return std::max<std::int64_t>(1, steps / 600); }

void run(const ExtremeCase& extreme, const scenes::Scene& scene, sim::World& world,
         ExtremeResult& result) {
  const auto steps =
      static_cast<std::int64_t>(std::llround(extreme.seconds * world.settings.steps_per_second));
  sim::Stepper stepper(world);
  Watch watch(world, extreme.may_not_cross, result);
  while (world.steps < steps) {
    throw_if_interrupted();
    if (const auto divergence = stepper.step(world)) {
      result.outcome = Outcome::diverged;
      result.message = divergence_error(scene.name, *divergence, world).what();
      break;
    }
    if (world.steps % steps_per_look(steps) != 0) continue;
    watch.look(world, 2 * world.steps > steps);
    if (!result.valid) break;
  }
  result.seconds = sim::time(world);
  if (result.outcome != Outcome::valid) return;
  if (result.valid) watch.look(world, true);
  watch.finish(extreme);
}

}  // namespace

ExtremeResult run_extreme(const ExtremeCase& extreme, const std::string& integrator) {
  ExtremeResult result;
  try {
    const std::vector<std::string> overrides = {"simulation.integrator=" + integrator};
    const scenes::Scene scene = scenes::parse_scene(extreme.scene, "extreme.toml", overrides);
    sim::World world = build_world(scene);
    for (sim::SoftBody& body : world.soft) prepare(body, extreme.start);
    run(extreme, scene, world, result);
  } catch (const scenes::SceneError& error) {
    result.outcome = Outcome::refused;
    result.message = error.what();
  }
  return result;
}

bool as_expected(const ExtremeCase& extreme, bool implicit, const ExtremeResult& result) {
  if (result.outcome == Outcome::valid && !result.valid) return false;
  if (result.outcome != Outcome::valid && result.message.empty()) return false;
  if (implicit) return result.outcome == extreme.implicit_outcome;
  return std::ranges::find(extreme.explicit_outcomes, result.outcome) !=
         extreme.explicit_outcomes.end();
}

std::string to_string(Outcome outcome) {
  static constexpr auto names = std::to_array<std::string_view>({"valid", "refused", "diverged"});
  return std::string(base::enum_name(names, outcome));
}

std::string to_string(const std::vector<Outcome>& outcomes) {
  std::string text;
  for (const Outcome outcome : outcomes) text += (text.empty() ? "" : " or ") + to_string(outcome);
  return text;
}

}  // namespace pneuma::app
