// The contact potential, and what friction and restitution do beside it.
//
//   B(x) = sum over pairs  m w kappa r f(d / r)  +  sum over vertices  A kappa r f((z + r) / r)
//
// with d the distance of a pair, w its weight in m^2, r its reach in m, m the mollifier of edges,
// kappa the stiffness in Pa and f the barrier. The ground is a plane one reach below z = 0: what
// lies on z = 0 is just not pushed, and nothing gets further down than a reach.
//
// The force on the vertices is the negative gradient of B, and two forces that only take energy,
// with lambda = -m dB/dd the size of a pair's force, e its restitution, mu its friction, v_n the
// speed at which it parts, v_t its sliding velocity, v_0 the regularisation speed:
//
//   restitution:  -(1 - e^2) g(v_n / v_0) lambda grad d,       g: parting_ramp's slope
//   friction:     -mu lambda_n h(|v_t| / v_0) v_t / |v_t|,     h: smooth_friction's slope
//
// at its weights, where lambda_n = lambda (1 - (1 - e^2) g) is what is left along the normal. What
// is pushed apart gets e^2 of the energy back that it gave, and so e times its speed, whatever its
// mass, its speed and the barrier: what restitution means for impulses.
#pragma once

#include <vector>

#include "sim/potential/barrier.h"
#include "sim/potential/near_pairs.h"
#include "sim/potential/pair_distance.h"

namespace pneuma::sim {

/// A pair, or a vertex above the ground, that is within its reach.
struct ActiveContact {
  std::array<int, 4> vertices{};
  int count = 4;    // of its vertices: 1 at the ground
  int first = 0;    // surfaces
  int second = -1;  // -1: the ground
  PairPoint point;
  double reach = 0.0;     // m
  double strength = 0.0;  // N
  FunctionValue barrier;  // barrier_at the distance: in J, without the mollifier
  double mollifier = 1.0;
  double threshold = 0.0;  // m^4, of the mollifier; 0: none
  double restitution = 0.0;
  double friction = 0.0;

  /// N
  double push() const { return -mollifier * barrier.slope; }
  bool is_mollified() const { return mollifier < 1.0; }
};

/// Appends to `active` what is within its reach, and returns the energy in J: infinite when
/// something touches. `active` is cleared first.
double find_active(const ContactSurfaces& surfaces, const VertexArray& positions,
                   const std::vector<ContactPair>& pairs, std::vector<ActiveContact>& active);

/// The energy alone.
double contact_energy(const ContactSurfaces& surfaces, const VertexArray& positions,
                      const std::vector<ContactPair>& pairs);

/// J, of a world as it lies.
double contact_energy(const World& world);

PairCorners corners_of(const ActiveContact& contact, const VertexArray& positions);

/// Adds dB/dx in N.
void add_gradient(const std::vector<ActiveContact>& active, const VertexArray& positions,
                  VertexArray& gradient);

/// d^2B/dx^2 of one contact of four vertices, as it is.
Mat12 contact_hessian(const ActiveContact& contact, const VertexArray& positions);

/// N on the first side, without what a mollifier adds to it: at `velocity` (m/s) of that side
/// against the second.
Vec3 contact_force(const ActiveContact& contact, const Vec3& velocity, double regularisation_speed);

/// Adds all of the above's forces in N.
void add_forces(const std::vector<ActiveContact>& active, const VertexArray& positions,
                const VertexArray& velocities, double regularisation_speed, VertexArray& forces);

/// m/s, of the first side against the second.
Vec3 relative_velocity(const ActiveContact& contact, const VertexArray& velocities);

}  // namespace pneuma::sim
