#include "sim/soft/bending.h"

#include <array>
#include <cmath>

#include "sim/soft/bent_hinge.h"

namespace pneuma::sim {
namespace {

/// `damping`: of a hinge, its place in the table, and dt/dx: f tau dt/dt.
template <class Damping>
void add_torques(const HingeTable& hinges, const VertexArray& positions, double rigidity,
                 int stride, VertexArray& forces, const Damping& damping) {
  const VertexReader x(positions), force(forces);
  const VertexWriter out(forces);
  for (std::size_t e = 0; e < hinges.corners.size(); ++e) {
    const HingeTable::Corners& corners = hinges.corners[e];
    const BentHinge bent = bend(hinges, e, x);
    if (bent.is_flat()) continue;
    const HingeGradient gradient = angle_gradient(bent);
    const double scale = -rigidity * hinges.weights[e];
    const auto add = [&](double factor, const HingeGradient& along) {
      const std::array rows = {along.a, along.b, along.c, along.d};
      for (std::size_t i = 0; i < 4; ++i) {
        const int row = stride * corners[i];
        out.put(row, fma(factor, rows[i], force[row]));
      }
    };
    add(scale * (bent.weight() * bent.sine + damping(bent, e, gradient)), gradient);
    if (bent.weight() < 1.0) add(-scale * bent.cosine, weight_gradient(bent));
  }
}

}  // namespace

double bending_energy(const SoftMesh& mesh, const VertexArray& positions, double rigidity) {
  return mesh.hinges ? bending_energy(*mesh.hinges, positions, rigidity) : 0.0;
}

double bending_energy(const HingeTable& hinges, const VertexArray& positions, double rigidity) {
  if (rigidity == 0.0) return 0.0;
  const VertexReader x(positions);
  double sum = 0.0;
  for (std::size_t e = 0; e < hinges.corners.size(); ++e) {
    const BentHinge bent = bend(hinges, e, x);
    // 1 - cosine, which near the rest angle would be rounding.
    const double turned =
        bent.cosine > 0.0 ? bent.sine * bent.sine / (1.0 + bent.cosine) : 1.0 - bent.cosine;
    sum += hinges.weights[e] * (bent.weight() * turned + (1.0 - bent.weight()));
  }
  return rigidity * sum;
}

void add_bending_forces(const HingeTable& hinges, const VertexArray& positions, double rigidity,
                        int stride, VertexArray& forces) {
  if (rigidity == 0.0) return;
  add_torques(hinges, positions, rigidity, stride, forces,
              [](const BentHinge&, std::size_t, const HingeGradient&) { return 0.0; });
}

void add_damped_bending_forces(const HingeTable& hinges, const VertexArray& positions,
                               const VertexArray& velocities, double rigidity,
                               double relaxation_time, int stride, VertexArray& forces) {
  const VertexReader v(velocities);
  add_torques(hinges, positions, rigidity, stride, forces,
              [&](const BentHinge& bent, std::size_t e, const HingeGradient& gradient) {
                const HingeTable::Corners& corners = hinges.corners[e];
                const double rate = dot(gradient.a, v[corners[0]]) +
                                    dot(gradient.b, v[corners[1]]) +
                                    dot(gradient.c, v[corners[2]]) + dot(gradient.d, v[corners[3]]);
                return relaxation_time * dashpot_fraction(bent) * rate;
              });
}

void hinge_states(const HingeTable& hinges, const VertexArray& positions,
                  std::vector<HingeState>& states) {
  states.clear();
  const VertexReader x(positions);
  for (std::size_t e = 0; e < hinges.corners.size(); ++e) {
    const BentHinge bent = bend(hinges, e, x);
    states.push_back(bent.is_flat() ? HingeState{}
                                    : HingeState{bent.angle, dashpot_fraction(bent)});
  }
}

/// K sin(t - t0) + c sin(t - t_start) is the sine of one angle: cosines and sines of t0 and
/// t_start, times K and c, add up to those of the angle at which the sum is at rest.
void join_dashpots(const HingeTable& at_rest, const std::vector<HingeState>& start, double ratio,
                   HingeTable& hinges) {
  for (std::size_t e = 0; e < start.size(); ++e) {
    const double dashpot = ratio * start[e].dashpot_fraction;
    const double cosine = at_rest.rest[e].cosine + dashpot * start[e].angle.cosine;
    const double sine = at_rest.rest[e].sine + dashpot * start[e].angle.sine;
    const double size = std::hypot(cosine, sine);
    hinges.weights[e] = size * at_rest.weights[e];
    hinges.rest[e] = size > 0.0 ? HingeAngle{cosine / size, sine / size} : HingeAngle{};
  }
}

}  // namespace pneuma::sim
