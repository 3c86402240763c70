#include "app/study/stability/stability_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/host/errors.h"
#include "app/world/build_world.h"
#include "sim/mesh/measure.h"
#include "sim/mesh/primitives.h"
#include "sim/soft/stability_limit.h"

namespace pneuma::app {
namespace {

using sim::Integrator;

constexpr double k_precision = 1.05;
constexpr int usual_rate = 60;  // steps/s

std::vector<Integrator> integrators_for(const sim::SoftBody& body) {
  std::vector<Integrator> integrators;
  for (const auto& [integrator, name] : scenes::integrator_names()) {
    if (sim::can_integrate(integrator, body.material)) integrators.push_back(integrator);
  }
  return integrators;
}

void set_stiffness(sim::SoftMaterial& material, double k) {
  material.k = k;
  material.k_max = k_max_over_k * k;
}

/// The same membrane in finer pieces: as heavy as a whole, and as large.
void set_mesh(sim::SoftBody& body, int subdivisions) {
  const double radius = 0.5 * sim::bounds(body.mesh->rest_positions).size().maxCoeff();
  const double mass = body.material.vertex_mass * body.mesh->topology.vertex_count();
  body.mesh = sim::make_soft_mesh(sim::make_icosphere(radius, subdivisions));
  body.positions = body.mesh->rest_positions;
  body.velocities = sim::VertexArray(body.positions.size());
  body.material.vertex_mass = mass / body.positions.size();
}

class Study {
 public:
  Study(const scenes::Scene& scene, const StabilityOptions& options,
        const std::function<void(const std::string&)>& say)
      : settings_(scene.settings), body_(first_soft_body(scene)), say_(say) {
    study_.scene = scene.name;
    study_.body = body_.name;
    study_.options = options;
    integrators_ = options.integrators.empty() ? integrators_for(body_) : options.integrators;
  }

  StabilityStudy run() {
    const StabilityOptions& options = study_.options;
    for (const double k : options.k) {
      const sim::World world = stiff_world(k);
      add("k", k, world);
      add_cells(k, world);
    }
    for (const double n : options.n) {
      add("n", n, varied([&](sim::SoftBody& body) { body.material.n = n; }));
    }
    for (const double mass : options.vertex_mass) {
      add("vertex_mass", mass,
          varied([&](sim::SoftBody& body) { body.material.vertex_mass = mass; }));
    }
    for (const int subdivisions : options.subdivisions) {
      const sim::World world = varied([&](sim::SoftBody& body) { set_mesh(body, subdivisions); });
      add("vertices", world.soft.front().positions.size(), world);
    }
    if (!options.k.empty()) {
      for (const Integrator integrator : integrators_) find_stiffness_limit(integrator);
    }
    return std::move(study_);
  }

 private:
  template <class Change>
  sim::World varied(const Change& change) const {
    sim::SoftBody body = body_;
    change(body);
    return body_at_rest(settings_, std::move(body));
  }
  sim::World stiff_world(double k) const {
    return varied([&](sim::SoftBody& body) { set_stiffness(body.material, k); });
  }

  void add(const std::string& name, double value, const sim::World& world) {
    const sim::SoftBody& body = world.soft.front();
    for (const Integrator integrator : integrators_) {
      say_(fmt::format("{}, {} = {:g}", integrator_name(integrator), name, value));
      StabilityPoint point{integrator, name, value};
      const double predicted =
          sim::stability_limit(integrator, *body.mesh, body.material, body.positions).step;
      if (std::isfinite(predicted)) point.predicted_step = predicted;
      point.stable_rate = find_stable_rate(world, integrator, study_.options.trial, point.trials);
      study_.points.push_back(std::move(point));
    }
  }

  void add_cells(double k, const sim::World& world) {
    TrialOptions options = study_.options.trial;
    options.most_steps = study_.options.most_map_steps;
    for (const Integrator integrator : integrators_) {
      say_(fmt::format("{}, map at k = {:g}", integrator_name(integrator), k));
      for (const int rate : study_.options.map_rates) {
        study_.map.push_back({integrator, k, try_step(world, integrator, rate, options)});
      }
    }
  }

  bool is_stable(Integrator integrator, double k) {
    say_(fmt::format("{}, k = {:g} at 1/{} s", integrator_name(integrator), k, usual_rate));
    return try_step(stiff_world(k), integrator, usual_rate, study_.options.trial).verdict ==
           Verdict::stable;
  }

  void find_stiffness_limit(Integrator integrator) {
    auto [least, greatest] = std::ranges::minmax(study_.options.k);
    StiffnessLimit limit{integrator};
    if (is_stable(integrator, greatest)) {
      limit = {integrator, greatest, true};
    } else if (is_stable(integrator, least)) {
      while (greatest > k_precision * least) {
        const double middle = std::sqrt(least * greatest);
        (is_stable(integrator, middle) ? least : greatest) = middle;
      }
      limit.k = least;
    }
    study_.limits.push_back(limit);
  }

  sim::Settings settings_;
  sim::SoftBody body_;
  const std::function<void(const std::string&)>& say_;
  std::vector<Integrator> integrators_;
  StabilityStudy study_;
};

/// 15, 30, 60, ... steps/s.
std::vector<int> doubled_rates(int count) {
  std::vector<int> rates;
  for (int i = 0, rate = fewest_steps_per_second; i < count; ++i, rate *= 2) rates.push_back(rate);
  return rates;
}

}  // namespace

StabilityOptions full_stability_sweep() {
  return {.trial = {},
          .integrators = {},
          .k = {1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8},
          .n = {0.0, 1.0, 10.0, 1e2, 1e3, 1e4},
          .vertex_mass = {1e-6, 1e-4, 1e-2, 1.0, 1e2},
          .subdivisions = {1, 2, 3},
          .map_rates = doubled_rates(13),  // to 1/61,440 s
          .most_map_steps = 1'000};
}

StabilityOptions short_stability_sweep() {
  return {.trial = {.seconds = 5.0, .most_steps = 1'000},
          .integrators = {},
          .k = {10.0, 1e3, 1e5},
          .n = {1.0, 1e2},
          .vertex_mass = {1e-2, 1.0},
          .subdivisions = {1, 2},
          .map_rates = doubled_rates(7),
          .most_map_steps = 200};
}

sim::SoftBody first_soft_body(const scenes::Scene& scene) {
  sim::World world = build_world(scene);
  if (world.soft.empty()) {
    throw UsageError(fmt::format(
        "{} has no soft body, whose stability could be studied; choose another scene, such as "
        "one_sphere",
        scene.name));
  }
  return std::move(world.soft.front());
}

std::vector<Integrator> integrators_of(const scenes::Scene& scene) {
  return integrators_for(first_soft_body(scene));
}

StabilityStudy study_stability(const scenes::Scene& scene, const StabilityOptions& options,
                               const std::function<void(const std::string&)>& say) {
  return Study(scene, options, say).run();
}

std::string stiffness_sentence(const StabilityStudy& study) {
  std::string text;
  for (const StiffnessLimit& limit : study.limits) {
    text += text.empty() ? fmt::format("at 1/{} s: ", usual_rate) : ", ";
    text += integrator_name(limit.integrator);
    if (limit.unlimited) {
      text += fmt::format(": no limit found up to k = {:g}", limit.k);
    } else if (limit.k == 0.0) {
      text += " at no k tried";
    } else {
      text += fmt::format(" up to k = {:.3g}", limit.k);
    }
  }
  return text;
}

}  // namespace pneuma::app
