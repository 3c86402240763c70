#include "sim/soft/stability_limit.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "sim/mesh/measure.h"
#include "sim/soft/damping.h"
#include "sim/soft/explicit_step.h"
#include "sim/soft/pressure_force.h"

namespace pneuma::sim {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Of the longer of its two times: steps are looked at from `finest` to `longest` in turn, then
/// halved. No integrator here becomes stable again beyond its limit. A motion damped so that it
/// just does not swing decays at half the rate `decay`: rk8 is stable up to 2 x 6.4.
constexpr double finest = 0.01;
constexpr double longest = 16.0;
constexpr int bisections = 30;
/// By which an eigenvalue of a stable step may exceed 1: rounding.
constexpr double stable_rounding = 1e-9;

/// Rounds in which the weight of the dashpots is brought into line with the limit, and doubled: a
/// swinging motion that dies away as well hides one that fails sooner for its dashpots.
constexpr int weight_rounds = 3;

struct OscillatorAcceleration {
  Oscillation motion;

  double operator()(const VertexArray& x, const VertexArray& v, VertexArray& result) const {
    result.rows() = -motion.squared_frequency * x.rows() - motion.decay * v.rows();
    return 1.0;
  }
};

/// The size of the largest eigenvalue of one step's matrix, whose columns are what becomes of (1,
/// 0) and (0, 1): those go along x and y of one vertex.
double amplification(Integrator integrator, const Oscillation& motion, double kept, double step) {
  ExplicitScratch scratch(1, integrator);
  SoftState start{VertexArray(1), VertexArray(1)};
  start.positions[0] = Vec3::UnitX();
  start.velocities[0] = Vec3::UnitY();
  VertexArray x(1), v(1);
  explicit_step(integrator, OscillatorAcceleration{motion}, step, start, x, v, scratch);
  v.rows() *= kept;
  const double half_trace = 0.5 * (x[0].x() + v[0].y());
  const double determinant = x[0].x() * v[0].y() - x[0].y() * v[0].x();
  const std::complex<double> root =
      std::sqrt(std::complex<double>(half_trace * half_trace - determinant));
  return std::max(std::abs(half_trace + root), std::abs(half_trace - root));
}

}  // namespace

double stability_limit(Integrator integrator, const Oscillation& motion, double kept) {
  const double rate = std::max(std::sqrt(motion.squared_frequency), motion.decay);
  if (is_implicit(integrator) || rate == 0.0) return infinite;
  const auto stable = [&](double step) {
    return amplification(integrator, motion, kept, step) <= 1.0 + stable_rounding;
  };
  double low = 0.0, high = 0.0;
  for (int i = 1; high == 0.0 && i * finest <= longest; ++i) {
    const double step = i * finest / rate;
    (stable(step) ? low : high) = step;
  }
  if (high == 0.0) return infinite;
  for (int i = 0; i < bisections; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

StabilityLimit stability_limit(Integrator integrator, double kept, const FindMotion& fastest,
                               const FindMotion& most_damped) {
  StabilityLimit limit{infinite, {}};
  if (is_implicit(integrator)) return limit;
  const auto take = [&](const Oscillation& motion) {
    const double step = stability_limit(integrator, motion, kept);
    if (step < limit.step) limit = {step, motion};
  };
  const double swings = stability_limit(integrator, {1.0, 0.0}),
               dies_away = stability_limit(integrator, {0.0, 1.0});
  double weight = 0.0;
  for (int round = 0; round <= weight_rounds; ++round) {
    take(fastest(weight));
    if (!std::isfinite(limit.step)) break;
    if (most_damped) take(most_damped(dies_away / limit.step));
    // By once this, an undamped motion and one that only dies away, which fail at the same step,
    // count alike. symplectic_euler fails where h^2 omega^2 + 2 h delta = 4, the others nearly so.
    const double times = std::ldexp(1.0, round);
    weight = times * swings * swings / (dies_away * limit.step);
  }
  return limit;
}

StabilityLimit stability_limit(Integrator integrator, const SoftMesh& mesh,
                               const SoftMaterial& material, const VertexArray& positions) {
  const VibrationMode motions(mesh, material, positions);
  return stability_limit(
      integrator, 1.0 - literal_fraction(material),
      [&](double weight) { return motions.along(motions.fastest(weight)); },
      [&](double weight) { return motions.along(motions.most_damped(weight)); });
}

namespace {

/// k sum l^2 and k sum l L in joule: at s times the size, the energy of the springs is half of
/// s^2 `squares` - 2 s `products`, but for a constant.
struct SpringSums {
  double squares = 0.0, products = 0.0;
};

SpringSums sum_springs(const SoftBody& body) {
  const SoftMesh& mesh = *body.mesh;
  SpringSums sums;
  for (int e = 0; e < mesh.topology.edge_count(); ++e) {
    const auto& [a, b] = mesh.topology.edges()[at(e)];
    const double length = (body.positions[b] - body.positions[a]).norm();
    sums.squares += body.material.k * length * length;
    sums.products += body.material.k * length * mesh.rest_lengths[at(e)];
  }
  return sums;
}

/// s at which the energy is minimal: s^2 squares - s products = 3 (P - p0) V. In closed form where
/// P V is nRT and nothing is outside, else by bisection: divided by s, the left side grows with s
/// and the right side falls.
double settled_size(const SoftBody& body, const SpringSums& springs) {
  const double squares = springs.squares, products = springs.products;
  const GasLaw law = gas_law(body.material);
  if (law.exponent == 1.0 && law.ambient_pressure == 0.0) {
    // In a unit, a power of two, in which squares are no larger than numbers can be.
    const double unit = std::ldexp(1.0, -std::ilogb(squares));
    const double p = unit * products, q = unit * squares, gas = unit * (3.0 * law.strength);
    return (p + std::sqrt(p * p + 4.0 * q * gas)) / (2.0 * q);
  }
  const double start = volume(body.mesh->topology, body.positions);
  const auto too_large = [&](double s) {
    const double v = start * s * s * s;
    return s * s * squares - s * products > 3.0 * gauge_pressure(law, v) * v;
  };
  double low = 1e-3, high = 1e3;
  for (int i = 0; i < bisections; ++i) {
    const double middle = std::sqrt(low * high);
    (too_large(middle) ? high : low) = middle;
  }
  return low;
}

}  // namespace

StabilityLimit settled_stability_limit(Integrator integrator, const SoftBody& body) {
  const SoftMesh& mesh = *body.mesh;
  const StabilityLimit now = stability_limit(integrator, mesh, body.material, body.positions);
  const SpringSums springs = sum_springs(body);
  if (!(springs.squares > 0.0)) return now;
  const double size = settled_size(body, springs);
  VertexArray enlarged(body.positions.size());
  const Vec3 centre = mean(body.positions);
  for (int v = 0; v < enlarged.size(); ++v) {
    enlarged[v] = centre + size * (body.positions[v] - centre);
  }
  const StabilityLimit settled = stability_limit(integrator, mesh, body.material, enlarged);
  return settled.step < now.step ? settled : now;
}

}  // namespace pneuma::sim
