// The incremental potential of a whole world: what one implicit step of all bodies together
// minimises,
//
//   E(x) = sum of the bodies' own  +  B(x)  +  D(x),
//
// with what bodies have alone (sim/soft/incremental_potential.h, box_inertia.h), the contact
// potential B (contact_potential.h) and what friction and restitution take, D (lagged_terms.h).
// Vertices that forces do not move are to come to their targets.
#pragma once

#include <memory>
#include <vector>

#include "sim/potential/box_inertia.h"
#include "sim/potential/contact_potential.h"
#include "sim/potential/lagged_terms.h"
#include "sim/potential/world_matrix.h"
#include "sim/soft/euler_solver.h"
#include "sim/soft/incremental_potential.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Positions at which the energy is known. Pairs are those among which contacts were looked for.
struct WorldPoint {
  VertexArray positions;            // m, of all surfaces
  std::vector<Pose> boxes;          // of the free ones, whose corners are among the positions
  std::vector<EnergyPoint> bodies;  // of those that move
  std::vector<ActiveContact> active;
  double energy = 0.0;     // J
  double magnitude = 0.0;  // J: the sizes of its terms, of which rounding is a fraction
};

/// Which form of the contacts' second derivative.
enum class ContactHessian {
  along_normals,  // without the curvature of the distance: positive
  whole,          // may be negative
};

class WorldEnergy {
 public:
  /// Refers to both; of the world its meshes and materials.
  WorldEnergy(const World& world, const ContactSurfaces& surfaces);

  /// A body that moves, of the world's soft ones.
  struct Body {
    int soft;
    int first_vertex;
    const SoftMesh* mesh;
    std::vector<std::array<int, 2>> opposite;
    IncrementalPotential energy;
  };
  const std::vector<Body>& bodies() const { return bodies_; }

  /// A box that moves freely.
  struct Box {
    int index;  // of the world's boxes
    int first_vertex;
    BoxInertia energy;
  };
  const std::vector<Box>& boxes() const { return boxes_; }

  WorldPoint make_point() const;

  /// Of a step of `beta` seconds from `bases`, one for each of bodies(), and `box_bases`, for each
  /// of boxes(); `targets` are those of all vertices that forces do not move. Without friction and
  /// restitution until start_lagged().
  void set_step(const World& world, double beta, const std::vector<EulerBase>& bases,
                const std::vector<RigidState>& box_bases, const VertexArray& targets);
  void start_lagged(const WorldPoint& point, const VertexArray& velocities, const VertexArray& base,
                    double beta);

  /// Fills in everything but the positions. False when a volume is not above zero, something
  /// touches or something is not finite: then the energy means nothing.
  bool evaluate(const std::vector<ContactPair>& pairs, WorldPoint& point) const;
  /// The corners of a point's free boxes.
  void place_boxes(WorldPoint& point) const;
  /// N, at a point that has been evaluated; zero where forces move nothing. Of free boxes it is
  /// contracted (box_frame.h).
  void gradient(const WorldPoint& point, VertexArray& gradient) const;
  void hessian(const WorldPoint& point, ContactHessian form, LaggedTerms::Form lagged,
               WorldMatrix& matrix) const;

  /// m: on longer ways the second derivative of friction and restitution means little.
  double lagged_length() const { return lagged_.length(); }
  const VertexArray& targets() const { return targets_; }
  /// N/m, the least of the bodies: with which the diagonal is shifted.
  double inertia() const;
  /// J, of any body's gas at most: what small changes are measured by.
  double gas_scale() const;

 private:
  static void add_hinges(const Body& body, const EnergyPoint& own, WorldMatrix& matrix);

  BoxFrame frame_of(const WorldPoint& point, std::size_t box) const;
  void add_boxes(const WorldPoint& point, WorldMatrix& matrix) const;

  const ContactSurfaces& surfaces_;
  std::vector<Body> bodies_;
  std::vector<Box> boxes_;
  LaggedTerms lagged_;
  VertexArray targets_;
  mutable std::vector<VertexArray> scratch_;  // per body
  mutable VertexArray slopes_;                // of all but inertia, at boxes' corners
};

}  // namespace pneuma::sim
