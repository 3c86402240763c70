// Model files as a test needs them: written here from scratch, so that reading them is tested by
// something else than the importer's own exporter.
#pragma once

#include <string>

#include "sim/mesh/triangle_mesh.h"

namespace pneuma::assets {

std::string obj_text(const sim::TriangleMesh& mesh);
std::string ply_text(const sim::TriangleMesh& mesh);
std::string ply_bytes(const sim::TriangleMesh& mesh);  // binary, little endian
std::string stl_text(const sim::TriangleMesh& mesh);
std::string stl_bytes(const sim::TriangleMesh& mesh);
std::string off_text(const sim::TriangleMesh& mesh);
std::string a3ds_bytes(const sim::TriangleMesh& mesh);
std::string dae_text(const sim::TriangleMesh& mesh);
std::string fbx_text(const sim::TriangleMesh& mesh);
std::string glb_bytes(const sim::TriangleMesh& mesh);

/// The text of a .gltf file, and the bytes of the file `buffer` beside it that it asks for.
std::string gltf_text(const sim::TriangleMesh& mesh, const std::string& buffer);
std::string gltf_buffer(const sim::TriangleMesh& mesh);

/// A cube of side 2 about the origin, as 8 vertices and 12 triangles.
sim::TriangleMesh cube();

/// The same surface with a vertex for each corner of each face, 24 in all.
sim::TriangleMesh cube_of_24();

/// A box without any symmetry: no turn and no reflection takes it to itself. Its coordinates are
/// exact in 32-bit numbers and short as text.
sim::TriangleMesh crooked_box();

/// Both meshes as one.
sim::TriangleMesh both(const sim::TriangleMesh& a, const sim::TriangleMesh& b);

sim::TriangleMesh moved(sim::TriangleMesh mesh, const sim::Vec3& by);
sim::TriangleMesh scaled(sim::TriangleMesh mesh, double by);

/// m^3 inside a closed mesh.
double enclosed_volume(const sim::TriangleMesh& mesh);

}  // namespace pneuma::assets
