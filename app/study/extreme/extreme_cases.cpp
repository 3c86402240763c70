#include "app/study/extreme/extreme_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

namespace pneuma::app {
namespace {

using Outcomes = std::vector<Outcome>;
const Outcomes stays_valid = {Outcome::valid};
const Outcomes diverged = {Outcome::diverged};
const Outcomes refused = {Outcome::refused};
// An explicit integrator may live through it, or say that it did not.
const Outcomes either = {Outcome::valid, Outcome::diverged};

/// A sphere of 58 vertices just above the ground, with some keys of its own.
std::string sphere(const std::string& keys, const std::string& position = "[0.0, 0.0, 3.5]") {
  return fmt::format("[[body]]\nposition = {}\n{}\n", position, keys);
}

/// A box 5,000 times as heavy as a soft body: more than the response of 5.3 can part.
constexpr double unbounded = std::numeric_limits<double>::infinity();

std::string settings(const std::string& keys) { return "[simulation]\n" + keys + "\n"; }

std::string cube(double mass, const std::string& position) {
  return fmt::format(
      "[[body]]\nkind = \"rigid\"\nsize = [2.0, 2.0, 2.0]\nmass = {}\nposition = {}\n", mass,
      position);
}

void add_materials(std::vector<ExtremeCase>& cases) {
  // rk4 is stable up to k of about 10^3 N/m at 1/60 s, and springs below 0.6 k_max (400 N/m).
  for (const auto& [k, outcomes] : {std::pair{"0.0", stays_valid},
                                    {"1.0", stays_valid},
                                    {"100.0", stays_valid},
                                    {"1e4", diverged},
                                    {"1e6", diverged},
                                    {"1e8", diverged}}) {
    cases.push_back({.name = fmt::format("k = {} N/m", k),
                     .scene = sphere(fmt::format("k = {}\nn = 1.0", k)),
                     .explicit_outcomes = outcomes});
  }
  for (const auto& [n, outcomes] : {std::pair{"0.0", stays_valid},
                                    {"1.0", stays_valid},
                                    {"100.0", either},
                                    {"1e4", either},
                                    {"1e6", diverged}}) {
    cases.push_back({.name = fmt::format("n = {} mol", n),
                     .scene = sphere(fmt::format("n = {}", n)),
                     .explicit_outcomes = outcomes});
  }
  cases.push_back({.name = "T = 0 K", .scene = sphere("temperature = 0.0")});
  cases.push_back({.name = "k = 1e6 and n = 1e4",
                   .scene = sphere("k = 1e6\nn = 1e4"),
                   .explicit_outcomes = diverged});
  for (const auto& [mass, outcomes] :
       {std::pair{"1e-6", diverged}, {"1e-3", diverged}, {"1e3", either}}) {
    cases.push_back({.name = fmt::format("vertices of {} kg", mass),
                     .scene = sphere(fmt::format("n = 1.0\nvertex_mass = {}", mass)),
                     .explicit_outcomes = outcomes});
  }
  cases.push_back({.name = "rho_g = 0", .scene = sphere("n = 1.0\nrho_g = 0.0")});
  // Drag at the rate -60 ln(0.001) = 414 1/s, of which rk4 is stable up to 2.79 in a step: 167 1/s
  // at 1/60 s.
  cases.push_back({.name = "rho_g = 0.999",
                   .scene = sphere("n = 1.0\nrho_g = 0.999"),
                   .explicit_outcomes = diverged});
  cases.push_back({.name = "rho_g = 1",
                   .scene = sphere("rho_g = 1.0"),
                   .explicit_outcomes = refused,
                   .implicit_outcome = Outcome::refused});
  cases.push_back({.name = "springs damped as much as is done",
                   .scene = sphere("n = 1.0\nk_max = 50.0"),
                   .explicit_outcomes = diverged});
  for (const char* restitution : {"0.0", "1.0"}) {
    cases.push_back({.name = fmt::format("restitution {}", restitution),
                     .scene = sphere(fmt::format("n = 1.0\nrestitution = {}", restitution))});
  }
}

void add_motions(std::vector<ExtremeCase>& cases) {
  cases.push_back(
      {.name = "no gravity", .scene = settings("gravity = [0, 0, 0]") + sphere("n = 1.0")});
  cases.push_back({.name = "gravity 1,000 m/s^2",
                   .scene = settings("gravity = [0, 0, -1000]") + sphere("n = 1.0"),
                   .explicit_outcomes = either});
  cases.push_back({.name = "dropped from 1 km",
                   .scene = sphere("n = 1.0", "[0, 0, 1000]"),
                   .seconds = 70.0});  // drag holds it at 16 m/s
  cases.push_back({.name = "dropped from 1 km without drag",
                   .scene = sphere("n = 1.0\nrho_g = 0.0", "[0, 0, 1000]"),
                   .seconds = 20.0,
                   .explicit_outcomes = either});
  // The whole body goes below the ground in one step, and is put back as a flat disc; to implicit
  // integrators the ground is a bound of the step itself.
  cases.push_back({.name = "hits the ground at 1,000 m/s",
                   .scene = sphere("n = 1.0\nvelocity = [0, 0, -1000]"),
                   .explicit_outcomes = diverged});
  cases.push_back(
      {.name = "hit by a cube at 1,000 m/s",
       .scene = sphere("n = 1.0") + cube(1.0, "[20, 0, 3.5]") + "velocity = [-1000, 0, 0]\n",
       .explicit_outcomes = either});
  // In one step it comes to fill the place of the whole body. Explicit integrators leave that
  // without a volume; with implicit ones contacts keep a part of it (response/keep_volume.h).
  cases.push_back({.name = "pressed flat by a box of 40 m at 500 m/s",
                   .scene = sphere("n = 1.0") +
                            "[[body]]\nkind = \"rigid\"\nsize = [40, 40, 40]\nmass = 1e5\n"
                            "position = [0, 0, 32]\nvelocity = [0, 0, -500]\n",
                   .explicit_outcomes = diverged});
  cases.push_back({.name = "a body 1e6 m away", .scene = sphere("n = 1.0", "[1e6, 0, 3.5]")});
  cases.push_back({.name = "100,000 steps at rest",
                   .scene = sphere("n = 1.0\nk = 10.0"),
                   .seconds = 100'000.0 / 60.0,
                   .large = true});
}

void add_starts(std::vector<ExtremeCase>& cases) {
  cases.push_back({.name = "starts flat",
                   .scene = sphere("n = 1.0"),
                   .explicit_outcomes = diverged,
                   .implicit_outcome = Outcome::diverged,
                   .start = ExtremeStart::flat});
  cases.push_back(
      {.name = "starts flat, empty", .scene = sphere("n = 0.0"), .start = ExtremeStart::flat});
  cases.push_back({.name = "starts inside out",
                   .scene = sphere("n = 1.0"),
                   .explicit_outcomes = diverged,
                   .implicit_outcome = Outcome::diverged,
                   .start = ExtremeStart::inside_out});
  cases.push_back({.name = "starts with its vertices scattered",
                   .scene = sphere("n = 1.0", "[0, 0, 12]"),
                   .explicit_outcomes = either,
                   .start = ExtremeStart::scattered});
  cases.push_back({.name = "starts in one point",
                   .scene = sphere("n = 1.0"),
                   .explicit_outcomes = diverged,
                   .implicit_outcome = Outcome::diverged,
                   .start = ExtremeStart::one_point});
  cases.push_back({.name = "starts in one point, empty",
                   .scene = sphere("n = 0.0"),
                   .start = ExtremeStart::one_point});
  cases.push_back({.name = "a flat box",
                   .scene = "[[body]]\nshape = \"box\"\nsize = [2.0, 2.0, 0.0]\n",
                   .explicit_outcomes = refused,
                   .implicit_outcome = Outcome::refused});
  cases.push_back({.name = "a needle",
                   .scene = "[[body]]\nshape = \"box\"\nsize = [10.0, 0.1, 0.1]\nposition = [0, 0, "
                            "2]\nn = 0.001\n",
                   .explicit_outcomes = either});
  cases.push_back({.name = "a pancake",
                   .scene = "[[body]]\nshape = \"box\"\nsize = [5.0, 5.0, 0.05]\nposition = [0, 0, "
                            "2]\nn = 0.001\n",
                   .explicit_outcomes = either});
}

void add_crowds(std::vector<ExtremeCase>& cases) {
  const std::string soft = "n = 1.0\n";
  // Swept contacts keep bodies apart that start apart: what starts in each other is for impulses.
  const std::string parted = settings("contact = \"impulses\"");
  // Their gas presses the bodies of a crowd flat against six others: the paper's seven particles a
  // body do not cover that.
  const std::string crowd = parted + "[simulation.particles]\nper_vertex = 0.25\n" + sphere(soft);
  cases.push_back(
      {.name = "two bodies in one place", .scene = parted + sphere(soft) + sphere(soft)});
  cases.push_back({.name = "one body inside another",
                   .scene = parted + sphere(soft) + sphere(soft + "radius = 1.0\n")});
  cases.push_back({.name = "fifty bodies piled in one spot",
                   .scene = crowd + "copies = [50, 1, 1]\nspacing = [0.01, 0, 0]\n",
                   // Of 80 starts 5 to 44 mm apart all were clear of each other from 3 s on. From
                   // 1.5 s on some still met as they flew apart, by up to 0.8 m.
                   .seconds = 6.0,
                   .large = true});
  cases.push_back({.name = "masses 1 to 1e6",
                   .scene = sphere(soft + "vertex_mass = 350.0\nk = 350.0") +
                            sphere(soft + "vertex_mass = 3.5e-4", "[0, 0, 12]"),
                   .explicit_outcomes = diverged});
  cases.push_back({.name = "a cube of 1e5 kg on a sphere",
                   .scene = sphere(soft) + cube(1e5, "[0, 0, 9]"),
                   .explicit_outcomes = either,
                   .penetration = unbounded});
  cases.push_back({.name = "no skin",
                   .scene = settings("skin_thickness = 0.0") + sphere(soft),
                   .explicit_outcomes = refused,
                   .implicit_outcome = Outcome::refused});
  // What is deeper than a quarter of their radius, 3.3 m with the gas, is parted as a whole.
  cases.push_back(
      {.name = "a skin of a micrometre",
       .scene = settings("skin_thickness = 1e-6") + sphere(soft) + sphere(soft, "[0.5, 0, 10]"),
       .penetration = 0.8});
  // Once the centre of one lies in the other they are.
  cases.push_back(
      {.name = "a skin larger than the bodies",
       .scene = settings("skin_thickness = 10.0") + sphere(soft) + sphere(soft, "[0.5, 0, 12]"),
       .penetration = 3.3});
  cases.push_back({.name = "40,962 vertices",
                   .scene = "[[body]]\nshape = \"icosphere\"\nsubdivisions = 6\nposition = [0, 0, "
                            "3.2]\nn = 1.0\nvertex_mass = 5e-4\nk = 1.0\n",
                   .seconds = 0.1,
                   .explicit_outcomes = either,
                   .large = true});
  cases.push_back({.name = "1,000 bodies",
                   .scene = crowd + "copies = [10, 10, 10]\nspacing = [7.5, 7.5, 7.5]\n",
                   .seconds = 0.5,
                   .large = true});
}

}  // namespace

std::vector<ExtremeCase> extreme_cases() {
  std::vector<ExtremeCase> cases;
  add_materials(cases);
  add_motions(cases);
  add_starts(cases);
  add_crowds(cases);
  std::ranges::move(impact_cases(), std::back_inserter(cases));
  return cases;
}

}  // namespace pneuma::app
