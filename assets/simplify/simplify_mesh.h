// Fewer vertices for a closed surface.
#pragma once

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::assets {

/// Shrinks edges of a closed, manifold, outward surface that touches itself nowhere to points until
/// it has no more than `most_vertices`: it stays such a surface, of the same genus, and keeps its
/// volume. Stops at more vertices where no edge is left that can shrink. A mesh that has no more is
/// returned as it is.
///
/// Edges go in the order of a quadric error (Garland and Heckbert, "Surface simplification using
/// quadric error metrics", 1997), to which the spread of the surface that a vertex stands for is
/// added: it makes triangles of even size, on which the longest stable step of a soft body
/// depends. The new vertex is the place of the least error of those that keep the volume (Lindstrom
/// and Turk, "Fast and memory efficient polygonal simplification", 1998).
sim::TriangleMesh simplify_mesh(const sim::TriangleMesh& mesh, int most_vertices);

}  // namespace pneuma::assets
