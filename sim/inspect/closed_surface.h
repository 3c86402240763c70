// The surfaces of soft bodies and of rigid boxes as one kind of thing, for questions about a world.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim/base/orientation.h"
#include "sim/mesh/triangle_mesh.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// Of a soft body its own vertices, edges and triangles; of a box its 8 corners and 12 edges, and
/// 12 triangles, two a face. A diagonal of a face is no edge of the box.
struct ClosedSurface {
  std::vector<base::Point> points;  // m
  std::vector<std::array<int, 2>> edges;
  std::vector<Triangle> triangles;  // counter-clockwise seen from outside
};

ClosedSurface closed_surface(const SoftBody& body);
ClosedSurface closed_surface(const RigidBox& box);

/// Of all bodies of a world: the soft bodies, then the boxes. This is what a body's index means
/// wherever both kinds are meant.
std::vector<ClosedSurface> closed_surfaces(const World& world);
const std::string& body_name(const World& world, int body);

}  // namespace pneuma::sim
