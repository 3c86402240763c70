#include "app/study/stability/step_cost.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/host/budget.h"
#include "app/record/statistics.h"
#include "app/study/csv.h"
#include "app/study/error/conclusions.h"
#include "app/study/stability/stability_study.h"
#include "app/terminal/table.h"
#include "app/world/build_world.h"
#include "app/world/replay.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

constexpr int swinging_steps = 60;  // after which a body is nearly at rest, and steps cheaper
constexpr double measuring_seconds = 1.0;

std::string icosphere(int subdivisions, int vertices) {
  return fmt::format(
      "shape = \"icosphere\"\nsubdivisions = {}\nn = 0.3\nk = {}\nvertex_mass = {}\n", subdivisions,
      50.0 * 642.0 / vertices, 20.0 / vertices);
}

std::vector<std::string> costed_bodies(bool few) {
  std::vector<std::string> bodies = {
      "shape = \"sphere\"\nn = 5.0\n",
      "shape = \"torus\"\nstacks = 16\nslices = 16\nn = 10.0\nk = 100.0\nk_max = 1000.0\n"};
  if (few) return bodies;
  bodies.push_back(icosphere(4, 2562));
  bodies.push_back(icosphere(5, 10242));
  return bodies;
}

double median_step(const scenes::Scene& scene) {
  std::vector<double> times;
  const Budget budget({}, measuring_seconds, swinging_steps);
  while (budget.more(static_cast<std::int64_t>(times.size()))) {
    sim::World world = build_world(scene);
    sim::Stepper stepper(world);
    for (int i = 0; i < swinging_steps; ++i) {
      const double start = thread_seconds();
      advance(stepper, world, 1, scene.name);
      times.push_back(thread_seconds() - start);
    }
  }
  return spread(std::move(times)).median;
}

/// The cheapest stable run that is good enough, of implicit integrators or of explicit ones.
std::optional<ErrorRun> cheapest(const ErrorStudy& study, bool implicit) {
  std::optional<ErrorRun> best;
  for (const ErrorRun& run : study.runs) {
    const bool is_implicit = run.method == "implicit_euler" || run.method == "sdirk2";
    if (!run.ours || is_implicit != implicit || run.status != ErrorRun::Status::stable) continue;
    if (error_of(run) > stiff_error) continue;
    if (!best || run.run_time < best->run_time) best = run;
  }
  return best;
}

std::string run_text(const std::optional<ErrorRun>& run) {
  return run ? fmt::format("{} 1/{} s: {}", run->method, run->steps_per_second,
                           readable(1e6 * run->run_time))
             : "none";
}

}  // namespace

std::vector<StepCost> measure_step_costs(bool few,
                                         const std::function<void(const std::string&)>& say) {
  std::vector<StepCost> costs;
  for (const std::string& body : costed_bodies(few)) {
    StepCost& cost = costs.emplace_back();
    for (std::size_t i = 0; i < costed_integrators.size(); ++i) {
      const std::string name = integrator_name(costed_integrators[i]);
      scenes::Scene scene = scenes::parse_scene(
          "[ground]\npresent = false\n[[body]]\n" + body, "cost.toml",
          std::vector<std::string>{"simulation.integrator=" + name, "simulation.gravity=[0,0,0]"});
      cost.vertices = build_world(scene).soft.front().positions.size();
      say(fmt::format("a step of {}, {} vertices", name, cost.vertices));
      cost.seconds[i] = median_step(scene);
    }
  }
  return costs;
}

std::string step_cost_text(const std::vector<StepCost>& costs) {
  std::vector<Table::Column> columns = {{"vertices"}};
  for (const sim::Integrator integrator : costed_integrators) {
    columns.push_back({integrator_name(integrator) + "\nus per step"});
    if (integrator != costed_integrators.front()) columns.push_back({"/ rk4"});
  }
  Table table(columns);
  for (const StepCost& cost : costs) {
    std::vector<std::string> cells = {grouped(cost.vertices)};
    for (std::size_t i = 0; i < cost.seconds.size(); ++i) {
      cells.push_back(readable(1e6 * cost.seconds[i]));
      if (i > 0) cells.push_back(fmt::format("{:.3g}", cost.seconds[i] / cost.seconds[0]));
    }
    table.add_row(cells);
  }
  return table.text();
}

std::string step_cost_csv(const std::vector<StepCost>& costs) {
  Csv csv({"vertices", "integrator", "step_s"});
  for (const StepCost& cost : costs) {
    for (std::size_t i = 0; i < cost.seconds.size(); ++i) {
      csv.add_row({csv_cell(cost.vertices), csv_cell(integrator_name(costed_integrators[i])),
                   csv_cell(cost.seconds[i])});
    }
  }
  return csv.text();
}

StiffChoice choose_for_stiffness(double k, const ErrorStudy& study) {
  return {k, cheapest(study, false), cheapest(study, true)};
}

std::vector<StiffChoice> study_stiffness(
    const std::function<scenes::Scene(const std::vector<std::string>&)>& load,
    const std::vector<double>& stiffnesses, bool few,
    const std::function<void(const std::string&)>& say) {
  ErrorOptions options = few ? short_sweep() : full_sweep();
  options.flight.free_flight = true;
  options.tolerances.clear();  // CVODE's own times are not asked for
  options.repeats = 2;
  options.longest_run = 5.0;
  std::vector<StiffChoice> choices;
  for (const double k : stiffnesses) {
    const scenes::Scene scene =
        load({fmt::format("body.k={}", k), fmt::format("body.k_max={}", k_max_over_k * k)});
    const ErrorStudy study = study_errors(scene, options, [&](const std::string& what) {
      say(fmt::format("cheapest at k = {:.3g}: {}", k, what));
    });
    choices.push_back(choose_for_stiffness(k, study));
  }
  return choices;
}

std::string stiffness_text(const std::vector<StiffChoice>& choices) {
  using Align = Table::Align;
  Table table({{"k, N/m"},
               {"cheapest explicit one, us per\nsimulated second", Align::left},
               {"cheapest implicit one", Align::left},
               {"cheaper", Align::left}});
  const StiffChoice* from = nullptr;
  for (const StiffChoice& choice : choices) {
    const char* cheaper = choice.implicit_wins() ? "implicit"
                          : choice.of_explicit   ? "explicit"
                                                 : "";
    table.add_row({fmt::format("{:.3g}", choice.k), run_text(choice.of_explicit),
                   run_text(choice.of_implicit), cheaper});
    if (!choice.implicit_wins()) from = nullptr;
    if (choice.implicit_wins() && from == nullptr) from = &choice;
  }
  const std::string sentence =
      from != nullptr
          ? fmt::format("for an error of 1e-2 implicit integrators are cheaper from k = {:.3g} on",
                        from->k)
          : "for an error of 1e-2 explicit integrators are cheaper at the max. k";
  return table.text() + "\n" + sentence + "\n";
}

std::string stiffness_csv(const std::vector<StiffChoice>& choices) {
  Csv csv({"k", "kind", "method", "steps_per_second", "run_time_s_per_s", "error"});
  for (const StiffChoice& choice : choices) {
    for (const auto& [kind, run] :
         {std::pair{"explicit", &choice.of_explicit}, {"implicit", &choice.of_implicit}}) {
      if (!*run) continue;
      csv.add_row({csv_cell(choice.k), csv_cell(kind), csv_cell((*run)->method),
                   csv_cell((*run)->steps_per_second), csv_cell((*run)->run_time),
                   csv_cell(error_of(**run))});
    }
  }
  return csv.text();
}

}  // namespace pneuma::app
