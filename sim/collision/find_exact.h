// The second search for contacts of two soft bodies: exhaustive, over a spatial subdivision,
// instead of the collision particles (the paper's section 7 names it as what to try next;
// ERRATA row 45).
//
// What is tested and what follows from a contact is as with particles: the six feature tests of
// 5.2.1.1 and the response of 5.3. Only the search differs. Every vertex of either body is tested
// against the other's nearest triangle, and so is every edge; a pair is a contact when what touches
// is that vertex, or that edge and not one of its ends, which a vertex's own test has found
// already. So everything of one body that is within reach of the other has its contact, and a flat
// patch that lies on another has one per vertex and per crossing of edges, not one for every pair
// of triangles.
#pragma once

#include <vector>

#include "sim/collision/contact.h"
#include "sim/collision/feature_contact.h"
#include "sim/collision/surface_grid.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Memory of find_exact; contents mean nothing between calls.
struct ExactScratch {
  SurfaceGrid grid;
  std::vector<FeatureContact> found;
  std::vector<int>
      partner;  // per feature of the first body, the feature that it was found to touch
};

/// Appends the contacts of two soft bodies, given by their indices in World::soft. Reach, depths
/// and normals are those of find_soft_soft.
void find_exact(const World& world, int first, int second, ExactScratch& scratch,
                std::vector<Contact>& contacts);

/// Two triangles of two surfaces, by index, and how far apart their nearest points are.
struct CloseTriangles {
  int first = 0;
  int second = 0;
  double distance = 0.0;  // m
};

/// All pairs of triangles less than `reach` (m) apart, ordered by (first, second): the truth that
/// studies of the search compare with.
std::vector<CloseTriangles> find_close_triangles(const SurfaceView& first,
                                                 const SurfaceView& second, double reach);

}  // namespace pneuma::sim
