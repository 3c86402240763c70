// How the pressure inside a body (paper 3.1.2; gas_law.h) pushes on every triangle along its
// outward normal.
#pragma once

#include "sim/mesh/soft_mesh.h"
#include "sim/soft/gas_law.h"

namespace pneuma::sim {

/// Writes dV/dx per vertex, in m^2: a third of the area vectors of the vertex's triangles, taken
/// over its ring. P times it is the pressure force with each triangle's force split evenly (ERRATA
/// row 3). Its last row stays zero.
void volume_gradient(const MeshTopology& topology, const VertexArray& positions,
                     VertexArray& gradient);

/// The volume in m^3 from its gradient. V is homogeneous of degree three in positions about any
/// centre, so by Euler's theorem 3 V = sum (x - c) . dV/dx.
double volume(const VertexArray& positions, const VertexArray& gradient);

/// m^3, by which that may be off. A body as thin as this has no volume that a double can tell.
double volume_rounding(const VertexArray& positions, const VertexArray& gradient);

}  // namespace pneuma::sim
