#include "app/accuracy/measured_steps.h"

#include "sim/base/enum_name.h"

namespace pneuma::app {
namespace {

using enum Situation;
using sim::Integrator;

/// From the tables of
///   pneuma study error SCENE --seconds 1.2 --repeats 1
/// of 2026-11-25 on one_sphere, one_torus, two_spheres, two_spheres_contact, sphere_in_torus and
/// torus_four_cubes, on one_sphere with --set body.k=1e4 and 1e5 --set body.k_max=1e9, and in free
/// flight on one_sphere, one_torus and stiff_torus (--free-flight --short --seconds 1). Set by hand
/// from single runs and rounded, not fitted: rates near which the worst scene has the error, times
/// its motion time. Estimates from few points: all of sdirk2, implicit_euler and the methods of
/// first order; costs; boxes, which rest on one scene; bodies at 1e-3, which rest on
/// two_spheres_contact and are far more than bodies need that do not meet. one_body at 1e-3: on
/// one_sphere the error goes up and down with the step (9.3e-4 at 1/960 s, 1.6e-3 at 1/1050 s,
/// 1.4e-5 at 1/1920 s), and 130 is the 72 of 1/1050 s with a margin of 1.8. Where `pneuma study
/// accuracy` of 2026-11-27 missed the error there are more: 20 and 23 for 14, 1100 for 900, 190 for
/// 100.
/// Implicit steps of several bodies: the mean, in powers, of two coarse spheres and the cat.
constexpr MeasuredStep all_steps[] = {
    // situation, integrator, {picture, 1e-2, 1e-3}, cost
    {free_flight, Integrator::rk4, {1.5, 2.5, 4.5}, 1.8},
    {free_flight, Integrator::velocity_verlet, {2.5, 6, 20}, 1.0},
    {free_flight, Integrator::sdirk2, {8, 18, 60}, 50},
    {one_body, Integrator::velocity_verlet, {3, 20, 130}, 1.0},
    {one_body, Integrator::rk4, {2.5, 20, 130}, 1.8},
    {one_body, Integrator::symplectic_euler, {9, 40, 0}, 0.7},
    {one_body, Integrator::martin, {21, 120, 0}, 1.9},
    {one_body, Integrator::sdirk2, {5, 18, 130}, 70},
    {one_body, Integrator::implicit_euler, {40, 0, 0}, 40},
    {bodies, Integrator::velocity_verlet, {4, 23, 1100}, 1.0},
    {bodies, Integrator::rk4, {3, 23, 1100}, 1.1},
    {bodies, Integrator::symplectic_euler, {15, 110, 0}, 1.0},
    {bodies, Integrator::sdirk2, {5, 23, 1100}, 220},
    {bodies, Integrator::implicit_euler, {15, 0, 0}, 110},
    {boxes, Integrator::velocity_verlet, {6, 14, 190}, 1.0},
    {boxes, Integrator::rk4, {6, 14, 190}, 1.15},
};

}  // namespace

std::string_view to_string(Situation situation) {
  static constexpr auto names = std::to_array<std::string_view>(
      {"free flight", "one soft body", "several soft bodies", "free boxes"});
  return base::enum_name(names, situation);
}

std::span<const MeasuredStep> measured_steps() { return all_steps; }

}  // namespace pneuma::app
