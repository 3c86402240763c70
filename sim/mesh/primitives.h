// The paper's meshes (section 6.2) and the ones its studies need. All are closed, outward oriented
// and centred on the origin, with the z axis as the axis of revolution.
#pragma once

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::sim {

/// A UV sphere: two poles and stacks - 1 circles of `slices` vertices. 8 x 8, the paper's sphere,
/// has 58 vertices, 168 edges and 112 triangles. stacks >= 2, slices >= 3.
TriangleMesh make_sphere(double radius, int stacks, int slices);

/// A torus: `stacks` circles of `slices` vertices around a tube of radius `tube_radius`, whose
/// centre line has radius `radius`. 16 x 16, the paper's torus, has 256 vertices, 768 edges and 512
/// triangles. stacks, slices >= 3, tube_radius < radius.
TriangleMesh make_torus(double radius, double tube_radius, int stacks, int slices);

/// An axis-aligned box of full lengths `size`, each face cut into divisions x divisions squares of
/// two triangles, with diagonals that run from the middle of the face to its corners: springs along
/// them would shear a box whose diagonals were all parallel. Of odd divisions the middle squares
/// favour one side. divisions = 1 gives 8 vertices and 12 triangles, the paper's cube.
TriangleMesh make_box(const Vec3& size, int divisions);

/// A subdivided icosahedron, 10 * 4^subdivisions + 2 vertices. Evenly spaced, for studies.
TriangleMesh make_icosphere(double radius, int subdivisions);

}  // namespace pneuma::sim
