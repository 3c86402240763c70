#include "sim/soft/bending.h"

#include <array>
#include <cmath>

#include "sim/soft/bent_hinge.h"
#include "sim/soft/four_hinges.h"

namespace pneuma::sim {
namespace {

/// Adds `factor` times a gradient to the forces of a hinge's corners.
class ForceSums {
 public:
  ForceSums(int stride, VertexArray& forces) : stride_(stride), force_(forces), out_(forces) {}

  void add(const HingeTable::Corners& corners, double factor, const HingeGradient& along) const {
    const std::array rows = {along.a, along.b, along.c, along.d};
    for (std::size_t i = 0; i < 4; ++i) {
      const int row = stride_ * corners[i];
      out_.put(row, fma(factor, rows[i], force_[row]));
    }
  }

 private:
  int stride_;
  VertexReader force_;
  VertexWriter out_;
};

/// `damping`: of a hinge, its place in the table, and dt/dx: f tau dt/dt.
template <class Damping>
void add_torque(const HingeTable& hinges, std::size_t e, const VertexReader& x, double rigidity,
                const ForceSums& sums, const Damping& damping) {
  const BentHinge bent = bend(hinges, e, x);
  if (bent.is_flat()) return;
  const HingeTable::Corners& corners = hinges.corners[e];
  const HingeGradient gradient = angle_gradient(bent);
  const double scale = -rigidity * hinges.weights[e];
  sums.add(corners, scale * (bent.weight() * bent.sine + damping(bent, e, gradient)), gradient);
  if (bent.weight() < 1.0) sums.add(corners, -scale * bent.cosine, weight_gradient(bent));
}

void add_four_torques(const HingeTable& hinges, std::size_t e, const FourHinges& four,
                      double rigidity, const ForceSums& sums) {
  const Vec4d factors = -rigidity * load_vec4d(&hinges.weights[e]) * four.turn(hinges, e).sine;
  const std::array<HingeGradient, 4> gradients = four.gradients();
  for (std::size_t i = 0; i < 4; ++i) sums.add(hinges.corners[e + i], factors[i], gradients[i]);
}

/// Calls four(e, hinges) for the hinges e to e + 3 together, and one(e) for those that cannot be
/// taken so, all in their order.
template <class Four, class One>
void for_each_four(const HingeTable& hinges, const VertexReader& x, const Four& four,
                   const One& one) {
  const std::size_t count = hinges.corners.size(), end = count - count % 4;
  for (std::size_t e = 0; e < end; e += 4) {
    const FourHinges together(hinges, e, x);
    if (together.have_whole_normals(hinges, e)) {
      four(e, together);
    } else {
      for (std::size_t i = 0; i < 4; ++i) one(e + i);
    }
  }
  for (std::size_t e = end; e < count; ++e) one(e);
}

/// Near the rest angle the difference itself would be rounding.
double one_less_cosine(double cosine, double sine) {
  return cosine > 0.0 ? sine * sine / (1.0 + cosine) : 1.0 - cosine;
}

}  // namespace

double bending_energy(const SoftMesh& mesh, const VertexArray& positions, double rigidity) {
  return mesh.hinges ? bending_energy(*mesh.hinges, positions, rigidity) : 0.0;
}

double bending_energy(const HingeTable& hinges, const VertexArray& positions, double rigidity) {
  if (rigidity == 0.0) return 0.0;
  const VertexReader x(positions);
  double sum = 0.0;
  const auto add_one = [&](std::size_t e) {
    const BentHinge bent = bend(hinges, e, x);
    const double turned = one_less_cosine(bent.cosine, bent.sine);
    sum += hinges.weights[e] * (bent.weight() * turned + (1.0 - bent.weight()));
  };
  for_each_four(
      hinges, x,
      [&](std::size_t e, const FourHinges& four) {
        const FourHinges::Turn turn = four.turn(hinges, e);
        for (std::size_t i = 0; i < 4; ++i) {
          sum += hinges.weights[e + i] * one_less_cosine(turn.cosine[i], turn.sine[i]);
        }
      },
      add_one);
  return rigidity * sum;
}

void add_bending_forces(const HingeTable& hinges, const VertexArray& positions, double rigidity,
                        int stride, VertexArray& forces) {
  if (rigidity == 0.0) return;
  const VertexReader x(positions);
  const ForceSums sums(stride, forces);
  const auto add_one = [&](std::size_t e) {
    add_torque(hinges, e, x, rigidity, sums,
               [](const BentHinge&, std::size_t, const HingeGradient&) { return 0.0; });
  };
  for_each_four(
      hinges, x,
      [&](std::size_t e, const FourHinges& four) {
        add_four_torques(hinges, e, four, rigidity, sums);
      },
      add_one);
}

void add_damped_bending_forces(const HingeTable& hinges, const VertexArray& positions,
                               const VertexArray& velocities, double rigidity,
                               double relaxation_time, int stride, VertexArray& forces) {
  const VertexReader x(positions), v(velocities);
  const ForceSums sums(stride, forces);
  const auto damping = [&](const BentHinge& bent, std::size_t e, const HingeGradient& gradient) {
    const HingeTable::Corners& corners = hinges.corners[e];
    const double rate = dot(gradient.a, v[corners[0]]) + dot(gradient.b, v[corners[1]]) +
                        dot(gradient.c, v[corners[2]]) + dot(gradient.d, v[corners[3]]);
    return relaxation_time * dashpot_fraction(bent) * rate;
  };
  for (std::size_t e = 0; e < hinges.corners.size(); ++e) {
    add_torque(hinges, e, x, rigidity, sums, damping);
  }
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
