// Extreme cases of contact: impacts, masses far apart, no room. Each by swept contacts and by the
// contact potential.
#include <fmt/format.h>

#include <limits>

#include "app/study/extreme/extreme_cases.h"

namespace pneuma::app {
namespace {

constexpr double any = std::numeric_limits<double>::infinity();
const std::vector<Outcome> survives = {Outcome::valid};
const std::vector<Outcome> survives_or_says = {Outcome::valid, Outcome::diverged};

/// Without gravity and ground, so that contacts alone can give energy.
std::string in_space(const std::string& contact, const std::string& bodies) {
  return fmt::format(
      "[simulation]\ngravity = [0, 0, 0]\ncontact = \"{}\"\n[ground]\npresent = false\n{}", contact,
      bodies);
}

std::string ball(double x, double speed, double vertex_mass, const std::string& more = "") {
  return fmt::format(
      "[[body]]\nposition = [{}, {}, 0.0]\nvelocity = [{}, 0, 0]\nvertex_mass = {}\n"
      "inflation = 1.05\nrho_g = 0.0\n{}",
      x, x < 0.0 ? 0.0 : 0.4, speed, vertex_mass, more);
}

/// A box of plates whose inside shrinks in a second from a cube of `from` (m) to one of `to`.
std::string shrinking_box(double from, double to) {
  constexpr double thickness = 2.0;
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      double place[3] = {0.0, 0.0, 0.0}, way[3] = {0.0, 0.0, 0.0};
      place[axis] = side * 0.5 * (from + thickness);
      way[axis] = side * 0.5 * (to - from);
      double size[3] = {from + thickness, from + thickness, from + thickness};
      size[axis] = thickness;
      text += fmt::format(
          "[[body]]\nkind = \"moved\"\nsize = [{}, {}, {}]\nposition = [{}, {}, {}]\n"
          "motion.path = [[0, 0, 0, 0], [1, {}, {}, {}]]\n",
          size[0], size[1], size[2], place[0], place[1], place[2], way[0], way[1], way[2]);
    }
  }
  return text;
}

void add_case(std::vector<ExtremeCase>& cases, const std::string& name, const std::string& contact,
              const std::string& bodies, const ExtremeCase& expected) {
  ExtremeCase extreme = expected;
  extreme.name = fmt::format("{}, {}", name, contact);
  extreme.scene = in_space(contact, bodies);
  extreme.may_not_cross =
      contact == "potential" ? Crossing::of_any_surface : Crossing::of_two_bodies;
  cases.push_back(std::move(extreme));
}

}  // namespace

std::vector<ExtremeCase> impact_cases() {
  std::vector<ExtremeCase> cases;
  for (const std::string contact : {"swept", "potential"}) {
    const bool is_slow = contact == "potential";
    for (const double speed : {10.0, 100.0, 1000.0}) {
      add_case(cases, fmt::format("two bodies meet at {} m/s", speed), contact,
               ball(-3.6, 0.5 * speed, 1.0) + ball(3.6, -0.5 * speed, 1.0),
               {.seconds = 1.0,
                .explicit_outcomes = speed > 10.0 ? survives_or_says : survives,
                .large = is_slow && speed > 100.0});
    }
    add_case(cases, "one of a millionth of the other's mass meets it at 10 m/s", contact,
             ball(-3.6, 0.0, 1.0) + ball(3.6, -10.0, 1e-6, "k = 5e-5\n"),
             {.seconds = 1.0, .explicit_outcomes = survives_or_says, .large = is_slow});
    add_case(cases, "a body in a box that shrinks to a tenth of its volume", contact,
             ball(-1e-3, 0.0, 1.0) + shrinking_box(8.0, 2.2),
             {.seconds = 1.0, .explicit_outcomes = survives_or_says, .energy_tolerance = any});
    add_case(cases, "a crowd in a box that shrinks", contact,
             "[[body]]\nshape = \"icosphere\"\nsubdivisions = 1\nradius = 1.5\nposition = [-1.6, "
             "-1.6, -1.6]\ncopies = [2, 2, 2]\nspacing = [3.2, 3.2, 3.2]\ninflation = 1.05\n" +
                 shrinking_box(8.0, 5.0),
             {.seconds = 1.0, .explicit_outcomes = survives_or_says, .energy_tolerance = any});
  }
  return cases;
}

}  // namespace pneuma::app
