// Collision particles: the search for the features by which two soft bodies may touch
// (paper 5.2.1).
//
// A particle rests on a feature of one body. It is drawn to the other body's particles and pushed
// away by its own body's, and walks from feature to neighbouring feature towards the lowest cost
//
//   cost = sum over the own body's other particles of 1/d^2  -  attraction * sum over the other's
//   of 1/d^2
//
// so that the particles of both bodies gather where the bodies face each other.
#pragma once

#include "sim/collision/surface_view.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// How many particles a body of so many vertices gets: a fraction of them, at least one.
int particle_count(int vertices, double per_vertex);

/// Puts particles on features drawn at random from the seed and the pair's own numbers, so that
/// they do not depend on when the pair meets (ERRATA row 40).
ParticlePair make_particles(int first, const MeshTopology& first_mesh, int second,
                            const MeshTopology& second_mesh, const ParticleSettings& settings,
                            std::uint64_t seed);

/// m. Particles nearer than a tenth of the skin cost no more than at that distance (ERRATA row 11);
/// without a skin, a micrometre bounds the cost of particles at one point.
double min_particle_distance(double skin_thickness);

/// Memory of settle_particles: where the particles are. Contents mean nothing between calls.
struct ParticleScratch {
  struct Point {
    float x, y, z;  // m
  };
  std::vector<Point> first;
  std::vector<Point> second;
};

/// Moves the particles until fewer than `settled_below` move in a sweep over all of them, or for
/// `max_sweeps` (ERRATA row 42). Each body has at least one. `min_distance` (m, at least 1e-6)
/// bounds d from below, so that two particles on one feature have a finite cost (ERRATA row 11).
/// Costs are compared in single precision (ERRATA row 43). Returns the number of sweeps.
int settle_particles(const SurfaceView& first, const SurfaceView& second,
                     const ParticleSettings& settings, double min_distance, ParticlePair& pair,
                     ParticleScratch& scratch);

}  // namespace pneuma::sim
