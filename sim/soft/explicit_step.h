// The explicit integrators, on any acceleration: that of a soft body, and the oscillator by which
// their stability is known.
//
// `acceleration(positions, velocities, result)` writes dv/dt and returns the volume at which it was
// evaluated (SoftAcceleration). Each step returns the least of these, not a number if one is not.
#pragma once

#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/soft/soft_state.h"
#include "sim/world.h"

namespace pneuma::sim {

/// Memory for a step of `count` vertices.
struct ExplicitScratch {
  explicit ExplicitScratch(int count) : stage_acceleration(count), sum_a(count), sum_v(count) {}

  VertexArray stage_acceleration, sum_a, sum_v;
};

/// The least volume met so far; a NaN, once met, stays.
class LeastVolume {
 public:
  void meet(double volume) {
    if (!(volume >= least_)) least_ = std::isnan(least_) ? least_ : volume;
  }
  double value() const { return least_; }

 private:
  double least_ = std::numeric_limits<double>::infinity();
};

/// Section 3.2 as written (ERRATA row 7): the stages of RK4 for the velocity, each position
/// advanced from the start with the stage's new velocity. First order, because the position moves
/// with the velocity of the step's end.
template <class Acceleration>
double martin(const Acceleration& acceleration, double h, const SoftState& start, VertexArray& x,
              VertexArray& v, ExplicitScratch& s) {
  LeastVolume least;
  const auto& x0 = start.positions.rows();
  const auto& v0 = start.velocities.rows();
  const auto& a = s.stage_acceleration.rows();
  auto& sum = s.sum_a.rows();

  least.meet(acceleration(start.positions, start.velocities, s.stage_acceleration));  // a0
  sum = a;
  for (const double share : {0.5, 0.5, 1.0}) {  // a1, a2, a3
    v.rows().noalias() = v0 + (share * h) * a;
    x.rows().noalias() = x0 + (share * h) * v.rows();
    least.meet(acceleration(x, v, s.stage_acceleration));
    sum += (share < 1.0 ? 2.0 : 1.0) * a;
  }
  v.rows().noalias() = v0 + (h / 6.0) * sum;
  x.rows().noalias() = x0 + h * v.rows();
  return least.value();
}

template <class Acceleration>
double symplectic_euler(const Acceleration& acceleration, double h, const SoftState& start,
                        VertexArray& x, VertexArray& v, ExplicitScratch& s) {
  const double volume = acceleration(start.positions, start.velocities, s.stage_acceleration);
  v.rows().noalias() = start.velocities.rows() + h * s.stage_acceleration.rows();
  x.rows().noalias() = start.positions.rows() + h * v.rows();
  return volume;
}

/// Kick, drift, kick. Damping makes the force depend on the velocity at the end of the step, which
/// is predicted with the first force: an error of order h^2 in it leaves the method second order.
template <class Acceleration>
double velocity_verlet(const Acceleration& acceleration, double h, const SoftState& start,
                       VertexArray& x, VertexArray& v, ExplicitScratch& s) {
  LeastVolume least;
  const auto& v0 = start.velocities.rows();
  const auto& a0 = s.sum_a.rows();
  const auto& a1 = s.stage_acceleration.rows();

  least.meet(acceleration(start.positions, start.velocities, s.sum_a));
  x.rows().noalias() = start.positions.rows() + h * v0 + (0.5 * h * h) * a0;
  v.rows().noalias() = v0 + h * a0;
  least.meet(acceleration(x, v, s.stage_acceleration));
  v.rows().noalias() = v0 + (0.5 * h) * (a0 + a1);
  return least.value();
}

/// The classical fourth-order Runge-Kutta method on (x, v).
template <class Acceleration>
double rk4(const Acceleration& acceleration, double h, const SoftState& start, VertexArray& x,
           VertexArray& v, ExplicitScratch& s) {
  LeastVolume least;
  const auto& x0 = start.positions.rows();
  const auto& v0 = start.velocities.rows();
  const auto& a = s.stage_acceleration.rows();
  auto& sum_a = s.sum_a.rows();
  auto& sum_v = s.sum_v.rows();

  least.meet(acceleration(start.positions, start.velocities, s.stage_acceleration));
  v.rows() = v0;
  sum_v = v0;
  sum_a = a;
  for (const double share : {0.5, 0.5, 1.0}) {
    const double weight = share < 1.0 ? 2.0 : 1.0;
    x.rows().noalias() = x0 + (share * h) * v.rows();  // v is still the last stage's
    v.rows().noalias() = v0 + (share * h) * a;
    least.meet(acceleration(x, v, s.stage_acceleration));
    sum_v += weight * v.rows();
    sum_a += weight * a;
  }
  x.rows().noalias() = x0 + (h / 6.0) * sum_v;
  v.rows().noalias() = v0 + (h / 6.0) * sum_a;
  return least.value();
}

/// Writes into `positions` and `velocities` the state `step` seconds after `start`.
template <class Acceleration>
double explicit_step(Integrator integrator, const Acceleration& acceleration, double step,
                     const SoftState& start, VertexArray& positions, VertexArray& velocities,
                     ExplicitScratch& scratch) {
  switch (integrator) {
    case Integrator::martin:
      return martin(acceleration, step, start, positions, velocities, scratch);
    case Integrator::symplectic_euler:
      return symplectic_euler(acceleration, step, start, positions, velocities, scratch);
    case Integrator::velocity_verlet:
      return velocity_verlet(acceleration, step, start, positions, velocities, scratch);
    case Integrator::rk4:
      return rk4(acceleration, step, start, positions, velocities, scratch);
    case Integrator::implicit_euler:
    case Integrator::sdirk2:
      break;
  }
  throw std::logic_error("implicit integrators are stepped by implicit_step()");
}

}  // namespace pneuma::sim
