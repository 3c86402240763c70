// Newton's method on the incremental potential of a whole world (world_energy.h).
//
// Directions are conjugate gradients' (world_matrix.h), with the diagonal shifted where the second
// derivative is not positive (as in sim/soft/minimise_energy.h). Each is cut to where no pair has
// used up nine tenths of its distance (continuous_collision.h), then halved until E has fallen by a
// fraction of what its slope promises: an accepted point never lies beyond a crossing. Where
// vertices are moved by keys they go along with the direction, and only what they leave of it is
// gone in the next iteration; until they have arrived E may grow, by their work.
//
// Free boxes turn along curves, so that a shorter way of theirs ends beside the longer one. What is
// swept is the straight ways of all vertices to where they are to be: between two of its poses a
// box is then sheared and shrunk a little, but at both of them rigid, and what separates them is
// crossed nowhere on the way. Poses that were not swept to are never accepted.
#pragma once

#include <vector>

#include "sim/potential/continuous_collision.h"
#include "sim/potential/kept_pairs.h"
#include "sim/potential/world_energy.h"

namespace pneuma::sim {

struct WorldMinimiserReport {
  int iterations = 0;
  bool converged = false;
  bool arrived = true;  // what is moved by keys
  WayLimit blocked;     // by what it is stopped, if it has not
  ContactPair blocked_pair;
};

class WorldMinimiser {
 public:
  /// Refers to both, which must outlive it.
  WorldMinimiser(const ContactSurfaces& surfaces, const WorldEnergy& energy);

  /// Where it starts: positions to be filled in, at which nothing crosses. Where it ends:
  /// evaluated.
  WorldPoint& point() { return point_; }
  const WorldPoint& point() const { return point_; }

  /// Looks for pairs around straight ways. They are kept as long as they hold.
  void find_pairs(const VertexArray& from, const VertexArray& to, double beside = 0.0);
  /// All pairs within their reach there, and more.
  const std::vector<ContactPair>& pairs_at(const VertexArray& positions);

  /// Finds the contacts at the start; false when its energy means nothing.
  bool begin();

  /// Ends when the next iteration would move no vertex by more than `tolerance` (m), or when E no
  /// longer falls by more than rounding.
  WorldMinimiserReport minimise(double tolerance);

  int gradient_iterations() const { return matrix_.iterations(); }

 private:
  const std::vector<ContactPair>& pairs_to(const VertexArray& ahead, double beside);
  bool is_arrived() const;
  void find_direction(int iteration);
  double max_turn() const;
  double longest_fraction(double turn, double size) const;
  void go(double fraction, WorldPoint& to) const;
  double margin_beside(double turn) const;
  double allowed_fraction(double fraction);
  double search_line(bool arrived, double size, WorldMinimiserReport& report);

  const ContactSurfaces& surfaces_;
  const WorldEnergy& energy_;
  KeptPairs kept_;
  double greatest_reach_ = 0.0;  // m
  WorldMatrix matrix_;
  WorldPoint point_, trial_;
  VertexArray gradient_, right_, direction_, given_, ahead_;
  double shift_ = 0.0;
  bool has_negative_curvature_ = false;  // E, along the direction
  double last_way_ = 0.0;                // m, of an iteration
  double free_fraction_ = 1.0;           // of the direction, before anything is in the way
  double forcing_ = 0.0;
  LaggedTerms::Form lagged_form_ = LaggedTerms::Form::derivative;
};

}  // namespace pneuma::sim
