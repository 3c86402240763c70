// The explicit integrators, on any acceleration: that of a soft body, and the oscillator by which
// their stability is known.
//
// `acceleration(positions, velocities, result)` writes dv/dt and returns the volume at which it was
// evaluated (SoftAcceleration). Each step returns the smallest of these volumes, not a number if
// one is not. An acceleration may also have `evaluate(positions, velocities)`, which gives one
// vertex's dv/dt at a time (Accelerations): then nothing is stored in between.
#pragma once

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sim/base/dormand_prince_8.h"
#include "sim/mesh/vec4d.h"
#include "sim/soft/soft_state.h"
#include "sim/world/settings.h"

namespace pneuma::sim {

/// Memory for a step of `count` vertices, of accelerations in m/s^2.
struct ExplicitScratch {
  ExplicitScratch(int count, Integrator integrator)
      : stage(count),
        first(count),
        sum(count),
        stages(integrator == Integrator::rk8 ? base::DormandPrince8::stages * count : 0) {}

  VertexArray stage, first, sum;
  VertexArray stages;  // rk8: of all its stages, those of a vertex side by side
};

/// The smallest volume met so far; a NaN, once met, stays.
class MinVolume {
 public:
  void meet(double volume) {
    if (!(volume >= min_)) min_ = std::isnan(min_) ? min_ : volume;
  }
  double value() const { return min_; }

 private:
  double min_ = std::numeric_limits<double>::infinity();
};

/// Evaluates the acceleration and calls take(vertex, dv/dt) for every vertex in turn, in which the
/// velocity of that vertex, but no other, may be changed. Returns the volume.
template <class Acceleration, class Take>
double for_each_acceleration(const Acceleration& acceleration, const VertexArray& positions,
                             const VertexArray& velocities, ExplicitScratch& scratch,
                             const Take& take) {
  const int count = positions.size();
  if constexpr (requires { acceleration.evaluate(positions, velocities); }) {
    const auto a = acceleration.evaluate(positions, velocities);
    for (int i = 0; i < count; ++i) take(i, a[i]);
    return a.volume();
  } else {
    const double volume = acceleration(positions, velocities, scratch.stage);
    const VertexReader a(scratch.stage);
    for (int i = 0; i < count; ++i) take(i, a[i]);
    return volume;
  }
}

/// Section 3.2 as written (ERRATA row 7): the stages of RK4 for the velocity, each position
/// advanced from the start with the stage's new velocity. First order, because the position moves
/// with the velocity of the step's end.
template <class Acceleration>
double martin(const Acceleration& acceleration, double h, const SoftState& start,
              VertexArray& positions, VertexArray& velocities, ExplicitScratch& s) {
  MinVolume min_volume;
  const VertexReader x0(start.positions), v0(start.velocities), sum(s.sum);
  const VertexWriter x(positions), v(velocities), new_sum(s.sum);
  /// Sums so far and the velocity to come: a0, then a1, a2 twice each.
  const auto stage = [=](double fraction, double weight) {
    return [=](int i, Vec4d a) {
      const Vec4d v_i = fma(fraction * h, a, v0[i]);
      v.put(i, v_i);
      x.put(i, fma(fraction * h, v_i, x0[i]));
      new_sum.put(i, fma(weight, a, sum[i]));
    };
  };
  const auto end = [=](int i, Vec4d a) {
    const Vec4d v_i = fma(h / 6.0, sum[i] + a, v0[i]);
    v.put(i, v_i);
    x.put(i, fma(h, v_i, x0[i]));
  };

  s.sum.rows().setZero();
  min_volume.meet(for_each_acceleration(acceleration, start.positions, start.velocities, s,
                                        stage(0.5, 1.0)));  // a0
  min_volume.meet(
      for_each_acceleration(acceleration, positions, velocities, s, stage(0.5, 2.0)));  // a1
  min_volume.meet(
      for_each_acceleration(acceleration, positions, velocities, s, stage(1.0, 2.0)));  // a2
  min_volume.meet(for_each_acceleration(acceleration, positions, velocities, s, end));  // a3
  return min_volume.value();
}

template <class Acceleration>
double symplectic_euler(const Acceleration& acceleration, double h, const SoftState& start,
                        VertexArray& positions, VertexArray& velocities, ExplicitScratch& s) {
  const VertexReader x0(start.positions), v0(start.velocities);
  const VertexWriter x(positions), v(velocities);
  return for_each_acceleration(acceleration, start.positions, start.velocities, s,
                               [=](int i, Vec4d a) {
                                 const Vec4d v_i = fma(h, a, v0[i]);
                                 v.put(i, v_i);
                                 x.put(i, fma(h, v_i, x0[i]));
                               });
}

/// Kick, drift, kick. Damping makes the force depend on the velocity at the end of the step, which
/// is predicted with the first force, p = v0 + h a0: an error of order h^2 in it leaves the method
/// second order. The end, v0 + h/2 (a0 + a1), is (v0 + p + h a1) / 2.
template <class Acceleration>
double velocity_verlet(const Acceleration& acceleration, double h, const SoftState& start,
                       VertexArray& positions, VertexArray& velocities, ExplicitScratch& s) {
  MinVolume min_volume;
  const VertexReader x0(start.positions), v0(start.velocities), predicted(velocities);
  const VertexWriter x(positions), v(velocities);
  min_volume.meet(for_each_acceleration(acceleration, start.positions, start.velocities, s,
                                        [=](int i, Vec4d a) {
                                          x.put(i, fma(h, fma(0.5 * h, a, v0[i]), x0[i]));
                                          v.put(i, fma(h, a, v0[i]));
                                        }));
  min_volume.meet(for_each_acceleration(
      acceleration, positions, velocities, s,
      [=](int i, Vec4d a) { v.put(i, 0.5 * fma(h, a, v0[i] + predicted[i])); }));
  return min_volume.value();
}

/// The classical fourth-order Runge-Kutta method on (x, v). Its velocities are v1 = v0 + h/2 a0, v2
/// = v0 + h/2 a1 and v3 = v0 + h a2, so that v0 + 2 v1 + 2 v2 + v3 = 6 v0 + h (a0 + a1 + a2): with
/// a0 and this sum, all sums are known.
template <class Acceleration>
double rk4(const Acceleration& acceleration, double h, const SoftState& start,
           VertexArray& positions, VertexArray& velocities, ExplicitScratch& s) {
  MinVolume min_volume;
  const VertexReader x0(start.positions), v0(start.velocities), last_v(velocities);
  const VertexReader a0(s.first), sum(s.sum);
  const VertexWriter x(positions), v(velocities), new_a0(s.first), new_sum(s.sum);

  min_volume.meet(for_each_acceleration(acceleration, start.positions, start.velocities, s,
                                        [=](int i, Vec4d a) {
                                          x.put(i, fma(0.5 * h, v0[i], x0[i]));
                                          v.put(i, fma(0.5 * h, a, v0[i]));
                                          new_a0.put(i, a);
                                        }));
  min_volume.meet(
      for_each_acceleration(acceleration, positions, velocities, s, [=](int i, Vec4d a) {
        x.put(i, fma(0.5 * h, last_v[i], x0[i]));
        v.put(i, fma(0.5 * h, a, v0[i]));
        new_sum.put(i, a0[i] + a);
      }));
  min_volume.meet(
      for_each_acceleration(acceleration, positions, velocities, s, [=](int i, Vec4d a) {
        x.put(i, fma(h, last_v[i], x0[i]));
        v.put(i, fma(h, a, v0[i]));
        new_sum.put(i, sum[i] + a);
      }));
  min_volume.meet(
      for_each_acceleration(acceleration, positions, velocities, s, [=](int i, Vec4d a) {
        x.put(i, fma(h, fma(h / 6.0, sum[i], v0[i]), x0[i]));
        v.put(i, fma(h / 6.0, fma(2.0, sum[i], a - a0[i]), v0[i]));
      }));
  return min_volume.value();
}

/// From the accelerations of rk8's stages before `next`, one vertex's own of them as given, the
/// state in which the next one is evaluated; after the last, the end of the step.
template <int next>
void rk8_state(int vertex, double h, const SoftState& start, const ExplicitScratch& s,
               VertexArray& positions, VertexArray& velocities) {
  using Coefficients = base::DormandPrince8;
  const VertexReader x0(start.positions), v0(start.velocities), a(s.stages);
  Vec4d to_velocity{}, to_position{};
  const auto add = [&]<int stage>(std::integral_constant<int, stage>) {
    constexpr double once = Coefficients::velocity[next][stage],
                     twice = Coefficients::position[next][stage];
    if constexpr (once != 0.0 || twice != 0.0) {
      const Vec4d rate = a[Coefficients::stages * vertex + stage];
      to_velocity = fma(once, rate, to_velocity);
      to_position = fma(twice, rate, to_position);
    }
  };
  [&]<int... stage>(std::integer_sequence<int, stage...>) {
    (add(std::integral_constant<int, stage>{}), ...);
  }
  (std::make_integer_sequence<int, next>{});
  const Vec4d way = fma(h, to_position, Coefficients::time[next] * v0[vertex]);
  VertexWriter(positions).put(vertex, fma(h, way, x0[vertex]));
  VertexWriter(velocities).put(vertex, fma(h, to_velocity, v0[vertex]));
}

/// Dormand and Prince's method of order 8 (dormand_prince_8.h) on (x, v). The velocity of a stage
/// is v0 + h times a sum of accelerations, and so is its position x0 + h c v0 + h^2 times another:
/// only accelerations are kept.
template <class Acceleration>
double rk8(const Acceleration& acceleration, double h, const SoftState& start,
           VertexArray& positions, VertexArray& velocities, ExplicitScratch& s) {
  constexpr int stages = base::DormandPrince8::stages;
  MinVolume min_volume;
  const VertexWriter rates(s.stages);
  const auto evaluate = [&]<int stage>(std::integral_constant<int, stage>) {
    const VertexArray& x = stage == 0 ? start.positions : positions;
    const VertexArray& v = stage == 0 ? start.velocities : velocities;
    min_volume.meet(for_each_acceleration(acceleration, x, v, s, [&](int i, Vec4d a) {
      rates.put(stages * i + stage, a);
      rk8_state<stage + 1>(i, h, start, s, positions, velocities);
    }));
  };
  [&]<int... stage>(std::integer_sequence<int, stage...>) {
    (evaluate(std::integral_constant<int, stage>{}), ...);
  }
  (std::make_integer_sequence<int, stages>{});
  return min_volume.value();
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
    case Integrator::rk8:
      return rk8(acceleration, step, start, positions, velocities, scratch);
    case Integrator::implicit_euler:
    case Integrator::sdirk2:
      break;
  }
  throw std::logic_error("implicit integrators are stepped by implicit_step()");
}

}  // namespace pneuma::sim
