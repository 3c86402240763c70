#include "app/study/solvers/solver_cases.h"

#include <fmt/format.h>

#include <cmath>

#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

struct Sphere {
  int vertices = 0;
  std::string shape;
};

std::vector<Sphere> spheres(bool few) {
  std::vector<Sphere> all = {{58, "shape = \"sphere\"\nstacks = 8\nslices = 8\n"}};
  for (const int subdivisions : {2, 3, 4, 5}) {
    if (few) break;
    all.push_back({10 * (1 << (2 * subdivisions)) + 2,
                   fmt::format("shape = \"icosphere\"\nsubdivisions = {}\n", subdivisions)});
  }
  return all;
}

/// scenes/one_sphere.toml. Vertices of a finer mesh share its mass, and its springs are as stiff,
/// so that the surface stays the same. What tumbles has too little gas to be blown up at once,
/// which would leave no spring slack.
scenes::Scene scene_of(const Sphere& sphere, bool tumbling) {
  const std::string toml = fmt::format(
      "title = \"A sphere, {}\"\n[[body]]\nname = \"sphere\"\nradius = 3.0\n{}k = 50.0\nn = {}\n"
      "temperature = 293.15\nvertex_mass = {}\n",
      tumbling ? "tumbling" : "blown up from rest", sphere.shape, tumbling ? 0.5 : 5.0,
      0.35 * 58.0 / sphere.vertices);
  return scenes::parse_scene(
      toml, fmt::format("sphere_{}_{}.toml", sphere.vertices, tumbling ? "tumbling" : "rest"));
}

/// Ours, of those that are cheapest for some error, may choose among four steps where each halves,
/// which is as fine as SUNDIALS' tolerances.
std::vector<int> step_rates(int most) {
  std::vector<int> rates = {15, 30, 45};
  for (int octave = 60; octave <= most; octave *= 2) {
    for (const int quarter : {4, 5, 6, 7}) rates.push_back(octave * quarter / 4);
  }
  return rates;
}

ErrorOptions options_of(bool few, bool tumbling) {
  ErrorOptions options = few ? short_sweep() : full_sweep();
  options.steps_per_second = step_rates(few ? 240 : 3840);
  options.integrators = {sim::Integrator::symplectic_euler, sim::Integrator::velocity_verlet,
                         sim::Integrator::rk4, sim::Integrator::rk8};
  options.finest_error = few ? 1e-4 : 8e-7;
  options.longest_run = few ? 1.0 : 4.0;
  options.flight.free_flight = true;
  options.flight.tumbling = tumbling;
  return options;
}

}  // namespace

std::vector<SolverCase> solver_cases(bool few) {
  std::vector<SolverCase> cases;
  for (const Sphere& sphere : spheres(few)) {
    for (const bool tumbling : {false, true}) {
      cases.push_back({sphere.vertices, scene_of(sphere, tumbling), options_of(few, tumbling)});
    }
  }
  return cases;
}

}  // namespace pneuma::app
