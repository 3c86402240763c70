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
/// just does not swing decays at half the rate `decay`: rk4 is stable up to 2 x 2.79.
constexpr double finest = 0.01;
constexpr double longest = 8.0;
constexpr int halvings = 30;
/// By which an eigenvalue of a stable step may exceed 1: rounding.
constexpr double stable_rounding = 1e-9;

/// Rounds in which the weight of the dashpots is brought into line with the limit.
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
  ExplicitScratch scratch(1);
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
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

StabilityLimit stability_limit(Integrator integrator, const SoftMesh& mesh,
                               const SoftMaterial& material, const VertexArray& positions) {
  StabilityLimit limit{infinite, {}};
  if (is_implicit(integrator)) return limit;
  const VibrationMode motions(mesh, material, positions);
  const double kept = 1.0 - literal_fraction(material);
  double weight = 0.0;
  for (int round = 0; round <= weight_rounds; ++round) {
    const Oscillation motion = motions.along(motions.fastest(weight));
    const double step = stability_limit(integrator, motion, kept);
    if (step < limit.step) limit = {step, motion};
    if (!std::isfinite(limit.step)) break;
    // symplectic_euler fails where h^2 omega^2 + 2 h delta = 4, the others nearly so.
    weight = 2.0 / limit.step;
  }
  return limit;
}

StabilityLimit settled_stability_limit(Integrator integrator, const SoftBody& body) {
  const SoftMesh& mesh = *body.mesh;
  const StabilityLimit now = stability_limit(integrator, mesh, body.material, body.positions);
  // At s times the size the energy k/2 sum (s l - L)^2 - 3 nRT ln s is minimal where
  // s^2 k sum l^2 - s k sum l L = 3 nRT.
  double squares = 0.0, products = 0.0;
  for (int e = 0; e < mesh.topology.edge_count(); ++e) {
    const auto& [a, b] = mesh.topology.edges()[at(e)];
    const double length = (body.positions[b] - body.positions[a]).norm();
    squares += body.material.k * length * length;
    products += body.material.k * length * mesh.rest_lengths[at(e)];
  }
  if (!(squares > 0.0)) return now;
  const double gas = 3.0 * gas_strength(body.material);
  const double size =
      (products + std::sqrt(products * products + 4.0 * squares * gas)) / (2.0 * squares);
  VertexArray enlarged(body.positions.size());
  const Vec3 centre = mean(body.positions);
  for (int v = 0; v < enlarged.size(); ++v) {
    enlarged[v] = centre + size * (body.positions[v] - centre);
  }
  const StabilityLimit settled = stability_limit(integrator, mesh, body.material, enlarged);
  return settled.step < now.step ? settled : now;
}

}  // namespace pneuma::sim
