// Which walls are beside a free box, along each of its axes: what SweptSearch finds and
// between_walls.h tells. Private to sim/step.
#pragma once

#include <optional>
#include <span>
#include <utility>

#include "sim/step/swept/swept_memory.h"

namespace pneuma::sim {

struct WallVelocity {
  Vec3 linear = Vec3::Zero();   // m/s
  Vec3 angular = Vec3::Zero();  // rad/s
};

/// Which of two bodies is a free box, and the other a wall or the ground; -1 if none is.
int box_beside_wall(const World& world, const SweptMemory& memory, const BodyPair& bodies);

/// Whether both of two bodies are free boxes.
bool are_free_boxes(const World& world, const SweptMemory& memory, const BodyPair& bodies);

/// On which side of the box the other is. `normal`: from the second to the first.
std::optional<BoxSide> side_of_wall(const SweptMemory& memory, const BodyPair& bodies, int box,
                                    const Vec3& normal);

/// Of a wall at a point: none of what stands still, or is no box.
WallVelocity velocity_of_wall(const World& world, const SweptMemory& memory, int body,
                              const Vec3& point);

/// m, of all gaps.
double room_between(const WallBeside& below, const WallBeside& above);

/// The free one of two bodies, or the first of two; -1 if none is.
int free_box(const World& world, const SweptMemory& memory, const BodyPair& bodies);

/// What is on both sides of that one along the axis on which the other, a wall or the next box of a
/// row, is beside it, if that is one of the `axes` of each box; or null.
const std::pair<WallBeside, WallBeside>* walls_along(const World& world, const SweptMemory& memory,
                                                     std::span<const std::uint8_t> axes,
                                                     const BodyPair& bodies, const Vec3& normal);

}  // namespace pneuma::sim
