// Vertices of a soft body that are held, as plain data.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/mesh/vertex_array.h"
#include "sim/world/key_frames.h"

namespace pneuma::sim {

/// Nothing that acts on a pinned vertex changes its motion: it rests, or is where the body's motion
/// puts it. A body all of whose vertices are pinned is an obstacle: it keeps its shape, and its
/// springs and gas do nothing.
struct Pins {
  std::vector<std::uint8_t> is_pinned;  // per vertex
  std::vector<std::uint8_t> follows;    // per vertex: it is pinned and follows the motion
  VertexArray start;                    // m, where the vertices are before any motion
  GivenMotion motion;                   // of those that follow, as of one rigid piece
  bool are_all = false;                 // all vertices are pinned
  bool are_moved = false;               // some follow
};

}  // namespace pneuma::sim
