// The explicit integrators on the equation of a whole world, contact included: every stage sees all
// bodies where they are then.
#pragma once

#include <vector>

#include "sim/potential/box_coordinates.h"
#include "sim/potential/contact_potential.h"
#include "sim/potential/continuous_collision.h"
#include "sim/potential/implicit_world_step.h"
#include "sim/potential/kept_pairs.h"
#include "sim/soft/acceleration.h"
#include "sim/soft/explicit_step.h"

namespace pneuma::sim {

/// The coordinates of boxes that an integrator takes.
BoxCoordinates::Form box_form_for(Integrator integrator);

/// The model's equation of all bodies of a world with contact (acceleration.h,
/// contact_potential.h), for explicit_step and for reference solvers. What forces do not move has
/// no acceleration. Free boxes have coordinates in the places of their corners (box_coordinates.h).
class WorldAcceleration {
 public:
  /// Refers to both; of the world its meshes, materials and gravity.
  WorldAcceleration(const World& world, const ContactSurfaces& surfaces, BoxCoordinates::Form form);

  /// Writes dv/dt in m/s^2. Returns the least volume of a body with gas in m^3, or 1: not above
  /// zero, or not a number, where the force means nothing. Pairs are looked for again when a vertex
  /// is further than what was looked around it.
  double operator()(const VertexArray& positions, const VertexArray& velocities,
                    VertexArray& acceleration) const;

  /// The coordinates of free boxes, in the order of the world's.
  void start_boxes(const std::vector<RigidState>& boxes, VertexArray& positions,
                   VertexArray& velocities);
  /// The boxes, and their corners in the place of their coordinates.
  void end_boxes(VertexArray& positions, VertexArray& velocities,
                 std::vector<RigidState>& boxes) const;

  /// m, of all vertices in the last evaluation, which was at these positions: the corners of free
  /// boxes in the places of their coordinates.
  const VertexArray& vertices(const VertexArray& positions) const {
    return boxes_.empty() ? positions : corners_;
  }

  /// The gas that its bodies hold now.
  void take_gas(const World& world) {
    for (Body& body : bodies_) body.equation.set_gas(world.soft[at(body.soft)].material);
  }
  /// m, around every vertex, from the next search on.
  void set_margin(double margin) { margin_ = margin; }
  /// All pairs that may meet on straight ways of all vertices, those of boxes included.
  const std::vector<ContactPair>& pairs_between(const VertexArray& from,
                                                const VertexArray& to) const;
  /// The greatest of h^2 K / m over the contacts of the last evaluation, K their stiffness.
  double contact_stiffness(double step) const;

 private:
  struct Body {
    int soft;
    int first_vertex;
    double vertex_mass;
    SoftAcceleration equation;
    VertexArray positions, velocities, acceleration;
  };
  struct Box {
    int index;    // of the world's
    int surface;  // its surface
    BoxCoordinates coordinates;
    RigidState state;
    BoxFrame frame;
  };
  void place_boxes(const VertexArray& positions, const VertexArray& velocities) const;
  double mobility_of_boxes(const ActiveContact& contact) const;

  const ContactSurfaces& surfaces_;
  std::vector<AccelerationScratch> scratch_;
  mutable std::vector<Body> bodies_;
  Vec3 gravity_;
  mutable std::vector<Box> boxes_;
  std::vector<double> inverse_mass_;  // 1/kg, per vertex of soft bodies; 0: no force moves it
  mutable KeptPairs kept_, between_;
  mutable std::vector<ActiveContact> active_;
  mutable VertexArray forces_;
  mutable VertexArray corners_, corner_velocities_;  // of all vertices, if there are free boxes
  double margin_ = 0.0;
};

struct ExplicitWorldReport {
  double min_volume = 1.0;  // m^3, as explicit_step reports it
  WayLimit limit;  // a pair that came too near, or met, on straight ways to the end or to a stage
  ContactPair limiting_pair;
  bool is_too_stiff = false;  // a contact of a stage, for the step
  int fast_box = -1;          // of the free ones, one that turns too far in the step
};

class ExplicitWorldStep {
 public:
  ExplicitWorldStep(const World& world, const ContactSurfaces& surfaces);

  /// One step of the world's settings. `end` is to be used only if nothing is limited and nothing
  /// too stiff: else the step is to be divided.
  ExplicitWorldReport step(const World& world, const WorldState& start, WorldState& end);

 private:
  const ContactSurfaces& surfaces_;
  WorldAcceleration acceleration_;
  ExplicitScratch scratch_;
  SoftState start_;
};

}  // namespace pneuma::sim
