// Runs the paper's scenes with Bullet and with ours in one process, and prints the ratios of their
// times beside what each simulated for it.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <exception>

#include "app/host/timing_conditions.h"
#include "app/record/provenance.h"
#include "app/terminal/table.h"
#include "app/world/build_world.h"
#include "app/world/find_scene.h"
#include "benchmarks/peer/equal_quality.h"
#include "benchmarks/peer/paired_run.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::benchmarks {
namespace {

using app::readable;

constexpr std::array paper_scenes = {
    "one_sphere",      "one_torus",        "two_spheres_contact", "three_spheres_contact",
    "sphere_in_torus", "torus_four_cubes", "cubes_on_torus"};

sim::World spheres(int along) {
  const std::string text = fmt::format(
      "[[body]]\nn = 1.0\ncopies = [{0}, {0}, 1]\nspacing = [9, 9, 9]\nposition = [0, 0, 3.5]\n",
      along);
  return app::build_world(scenes::parse_scene(text, "spheres.toml"));
}

std::string times(double ratio) { return fmt::format("{:.1f}x", ratio); }

void print_runs(const std::vector<PairedRun>& runs) {
  using Align = app::Table::Align;
  app::Table table({{"scene", Align::left},
                    {"Bullet", Align::right, "us per 1/60 s"},
                    {"rk4", Align::right, "us per 1/60 s"},
                    {"verlet", Align::right, "us per 1/60 s"},
                    {"rk4", Align::right, "Bullet takes"},
                    {"verlet", Align::right, "Bullet takes"},
                    {"Bullet", Align::right, "contacts"},
                    {"rk4", Align::right, "contacts"},
                    {"Bullet", Align::right, "V end / V start"},
                    {"rk4", Align::right, "V end / V start"},
                    {"Bullet", Align::right, "m/s at the end"},
                    {"rk4", Align::right, "m/s at the end"}});
  for (const PairedRun& run : runs) {
    const auto microseconds = [](const SideResult& side) {
      const int steps = side.steps_per_second / 60;
      const std::string text = readable(1e6 * side.frame_seconds());
      return steps > 1 ? fmt::format("{} ({} steps)", text, steps) : text;
    };
    const double bullet = run.bullet.frame_seconds();
    table.add_row({run.name, microseconds(run.bullet), microseconds(run.rk4),
                   microseconds(run.velocity_verlet), times(bullet / run.rk4.frame_seconds()),
                   times(bullet / run.velocity_verlet.frame_seconds()),
                   readable(run.bullet.contacts_per_step), readable(run.rk4.contacts_per_step),
                   readable(run.bullet.volume_ratio), readable(run.rk4.volume_ratio),
                   readable(run.bullet.end_speed), readable(run.rk4.end_speed)});
  }
  fmt::print("{}\n", table.text());
}

void print_tries(const std::string& side, const std::vector<QualityTry>& tries) {
  app::Table table({{side, app::Table::Align::left},
                    {"ms per simulated second"},
                    {"greatest error\nof the volume"}});
  for (const QualityTry& one : tries) {
    table.add_row(
        {one.setting, readable(1e3 * one.seconds_per_second), readable(one.volume_error)});
  }
  fmt::print("{}\n", table.text());
}

void print(const QualityComparison& comparison) {
  fmt::print("{} vertices on the ground: each side's settings.\n\n", comparison.vertices);
  print_tries("Bullet", comparison.bullet);
  print_tries("ours", comparison.ours);
  const QualityTry* bullet = cheapest_good(comparison.bullet);
  const QualityTry* ours = cheapest_good(comparison.ours);
  if (bullet == nullptr || ours == nullptr) {
    fmt::print("{} keeps the volume within 10 % at none of them.\n\n",
               ours == nullptr ? "ours" : "Bullet");
    return;
  }
  fmt::print(
      "Cheapest within 10 % of the volume: ours with {}, Bullet with {}: Bullet takes {}.\n\n",
      ours->setting, bullet->setting, times(bullet->seconds_per_second / ours->seconds_per_second));
}

struct Typed {
  std::vector<std::string> scenes;
  bool is_short = false;
};

void run(const Typed& typed) {
  fmt::print("{}\n", app::provenance_text(app::utc_date()));
  for (const std::string& warning : app::timing_warnings(app::timing_conditions())) {
    fmt::print("warning: {}\n", warning);
  }
  PairedRunOptions options;
  if (typed.is_short) options = {.seconds = 1.0, .repeats = 1};
  std::vector<std::string> names = typed.scenes;
  if (names.empty()) names.assign(paper_scenes.begin(), paper_scenes.end());
  std::vector<PairedRun> runs;
  for (const std::string& name : names) {
    const sim::World world = app::build_world(scenes::load_scene(app::find_scene(name)));
    runs.push_back(run_paired(name, world, options));
  }
  if (!typed.scenes.empty()) return print_runs(runs);
  if (!typed.is_short) options.seconds = 2.0;
  runs.push_back(run_paired("100 spheres", spheres(10), options));
  if (!typed.is_short) {
    options.repeats = 3;
    runs.push_back(run_paired("1,000 spheres", spheres(32), options));
    options.threads = 2;
    runs.push_back(run_paired("the same, ours on 2 threads", spheres(32), options));
  }
  print_runs(runs);
  for (const int subdivisions : {4, 5}) {
    if (typed.is_short && subdivisions == 5) break;
    print(compare_quality(subdivisions, typed.is_short ? 1.0 : 5.0));
  }
}

}  // namespace
}  // namespace pneuma::benchmarks

int main(int argc, char** argv) {
  using namespace pneuma::benchmarks;
  CLI::App command("Bullet's time per step beside ours, and what each simulated");
  Typed typed;
  command.add_option("SCENE", typed.scenes, "Scenes [the paper's, many spheres, fine spheres]");
  command.add_flag("--short", typed.is_short, "One second of each, once");
  CLI11_PARSE(command, argc, argv);
  try {
    run(typed);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
