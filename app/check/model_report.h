// What a clean model is like: numbers by which to choose its scale, stiffness and time step.
#pragma once

#include "assets/clean_mesh.h"

namespace pneuma::app {

struct ModelReport {
  int vertices_before = 0;  // of the whole file
  int vertices_welded = 0;  // of all triangles of the file
  int vertices = 0;         // of the component kept, as all that follows
  int edges = 0;
  int triangles = 0;
  int boundary_edges = 0;
  int non_manifold_edges = 0;
  int genus = 0;                       // handles: 0 of a sphere, 1 of a torus
  double volume = 0.0;                 // m^3
  double area = 0.0;                   // m^2
  sim::Vec3 size = sim::Vec3::Zero();  // m, of the bounding box
  double edge_5th = 0.0;               // m: percentiles of the edges' lengths
  double edge_median = 0.0;            // m
  double edge_95th = 0.0;              // m
  double smallest_angle = 0.0;         // degrees, of all triangles
  double springs_per_vertex = 0;       // the mean
  int fewest_springs = 0;              // of a vertex
  int most_springs = 0;
  sim::Vec3 most_springs_at = sim::Vec3::Zero();  // m, the first vertex that has so many
};

/// `model` as clean_mesh made it.
ModelReport report_on(const assets::CleanModel& model);

}  // namespace pneuma::app
