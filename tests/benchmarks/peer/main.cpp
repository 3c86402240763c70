// Runs the paper's scenes with Bullet and with ours in one process, and prints the ratios of their
// times beside what each simulated for it.
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <cstdio>
#include <exception>

#include "app/files/find_scene.h"
#include "app/host/timing_conditions.h"
#include "app/record/provenance.h"
#include "app/terminal/table.h"
#include "app/world/build_world.h"
#include "benchmarks/peer/bullet_settings.h"
#include "benchmarks/peer/equal_quality.h"
#include "benchmarks/peer/paired_run.h"
#include "benchmarks/peer/print_runs.h"
#include "benchmarks/peer/search_setting.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::benchmarks {
namespace {

using app::readable;

constexpr std::array paper_scenes = {
    "one_sphere",          "one_torus",        "two_spheres",
    "two_spheres_contact", "three_spheres",    "three_spheres_contact",
    "sphere_in_torus",     "torus_four_cubes", "cubes_on_torus"};

sim::World spheres(int along) {
  const std::string text = fmt::format(
      "[[body]]\nn = 1.0\ncopies = [{0}, {0}, 1]\nspacing = [9, 9, 9]\nposition = [0, 0, 3.5]\n",
      along);
  return app::build_world(scenes::parse_scene(text, "spheres.toml"));
}

std::string times(double ratio) { return fmt::format("{:.1f}x", ratio); }

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
  bool searches = false;
};

sim::World load(const std::string& scene) {
  return app::build_world(scenes::load_scene(app::find_scene(scene)));
}

void search(const std::vector<std::string>& scenes, double seconds) {
  for (const std::string& scene : scenes) {
    const sim::World world = load(scene);
    fmt::print("{}\n",
               search_text(scene, search_setting(scene, world, seconds, search_grid(world))));
    std::fflush(stdout);  // a scene takes minutes
  }
}

void compare(const Typed& typed, const std::vector<std::string>& scenes, PairedRunOptions options) {
  std::vector<PairedRun> runs;
  for (const std::string& scene : scenes) {
    runs.push_back(run_paired(scene, load(scene), bullet_setting(scene), options));
  }
  fmt::print("{}\n", runs_text(runs));
  if (!typed.scenes.empty()) return;
  runs.clear();
  const BulletOptions& many = bullet_setting("three_spheres");  // of the same material
  if (!typed.is_short) options.seconds = 2.0;
  runs.push_back(run_paired("100 spheres", spheres(10), many, options));
  if (!typed.is_short) {
    options.repeats = 3;
    runs.push_back(run_paired("1,000 spheres", spheres(32), many, options));
    options.threads = 2;
    runs.push_back(run_paired("the same, ours on 2 threads", spheres(32), many, options));
  }
  fmt::print("{}\n", runs_text(runs));
  for (const int subdivisions : {4, 5}) {
    if (typed.is_short && subdivisions == 5) break;
    print(compare_quality(subdivisions, typed.is_short ? 1.0 : 5.0));
  }
}

void run(const Typed& typed) {
  fmt::print("{}{}\n", app::provenance_text(app::utc_date()), builds_text());
  for (const std::string& warning : app::timing_warnings(app::timing_conditions())) {
    fmt::print("warning: {}\n", warning);
  }
  PairedRunOptions options;
  if (typed.is_short) options = {.seconds = 1.0, .repeats = 1};
  std::vector<std::string> scenes = typed.scenes;
  if (scenes.empty()) scenes.assign(paper_scenes.begin(), paper_scenes.end());
  if (typed.searches) return search(scenes, options.seconds);
  compare(typed, scenes, options);
}

}  // namespace
}  // namespace pneuma::benchmarks

int main(int argc, char** argv) {
  using namespace pneuma::benchmarks;
  CLI::App command("Bullet's time per step beside ours, and what each simulated");
  Typed typed;
  command.add_option("SCENE", typed.scenes, "Scenes [the paper's, many spheres, fine spheres]");
  command.add_flag("--short", typed.is_short, "One second of each, once");
  command.add_flag("--search", typed.searches,
                   "Look for the cheapest setting of Bullet that simulates each scene as ours");
  CLI11_PARSE(command, argc, argv);
  try {
    run(typed);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
