// The bodies of one frame as the bytes of a mesh file.
#pragma once

#include <array>
#include <span>
#include <string>

#include "app/export/exported_mesh.h"
#include "app/export/sink/bytes.h"

namespace pneuma::app {

/// Scenes are called after their files, which may be called anything: without control characters.
std::string one_line(std::string text);

/// A kind of mesh file, whose name is its ending. `comment` is one line.
struct MeshFormat {
  const char* name;
  Bytes (*encode)(std::span<const ExportedMesh> meshes, const std::string& comment);
};

/// All bodies as one mesh, binary, coordinates in double precision: exactly the simulation's.
/// Vertices have an sRGB colour and `body`, the number of their body; comments name the bodies.
Bytes encode_ply(std::span<const ExportedMesh> meshes, const std::string& comment);

/// An object per body. Coordinates with 17 digits, which read back exactly; after them the colour.
Bytes encode_obj(std::span<const ExportedMesh> meshes, const std::string& comment);

/// glTF 2.0, a node and a mesh per body. Its coordinates are single precision by definition; its
/// +y is up, so that the bodies hang below a node that turns +z there.
Bytes encode_glb(std::span<const ExportedMesh> meshes, const std::string& comment);

/// What `pneuma export --format` takes.
inline constexpr std::array<MeshFormat, 3> mesh_formats = {
    {{"ply", encode_ply}, {"obj", encode_obj}, {"glb", encode_glb}}};

}  // namespace pneuma::app
