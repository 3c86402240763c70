// Model files through the importer library.
#pragma once

#include <cstddef>
#include <filesystem>

#include "assets/model.h"

namespace pneuma::assets {

struct ImportLimits {
  std::size_t bytes = std::size_t{64} << 20;  // of all files of the model together
  // As a file counts them, which may be six times and more what there is: a file that gives each
  // corner of each triangle a vertex of its own has three per triangle, and a closed surface has
  // two triangles per vertex.
  std::size_t vertices = 800'000;
  std::size_t triangles = 800'000;
};

/// Reads OBJ, PLY, STL, OFF, glTF, GLB, 3DS, DAE and FBX, by the file's ending. Polygons come as
/// triangles, objects in the places that the file gives them, instances as often as it shows them.
/// Axes and units are the file's own: nothing is turned so that some axis is up. All coordinates
/// are finite, all indices in range.
///
/// Nothing is read but the file, and of glTF the .bin files beside it; no textures, materials,
/// lights, cameras or animations.
///
/// The importer runs in a process of its own (run_in_sandbox.h), because assimp 5.2 has known
/// faults on damaged files in most of these formats, among them writes beyond the end of its
/// memory: https://github.com/assimp/assimp/issues/5729 (PLY), 4843 (PLY), 4923 and 4925 (OBJ),
/// 6522 (DAE), 6772 (FBX). Counts in PLY, OFF and STL headers are checked before.
///
/// Throws ModelError, whose message begins with the path; std::system_error when no process can be
/// started.
Model import_model(const std::filesystem::path& path, const ImportLimits& limits = {});

}  // namespace pneuma::assets
