// Contacts that rigid boxes take part in (paper 5.2.2, 5.2.3), and those with the ground.
#pragma once

#include <span>
#include <vector>

#include "sim/collision/contact.h"
#include "sim/collision/oriented_box.h"
#include "sim/collision/triangle_columns.h"
#include "sim/collision/vertex_columns.h"
#include "sim/world/world.h"

namespace pneuma::sim {

/// How boxes rest (ERRATA row 63).
struct RestingLengths {
  /// Speculative margin, m. Points this near are contacts already, so that boxes at rest do not
  /// lose each other to rounding; impulses let them come nearer by it.
  double margin;
  /// m by which boxes are left in each other: pushing the deepest point out altogether would lift
  /// the other points off, and the boxes would rattle.
  double overlap;
};

/// 5 mm and 2.5 mm, less when the shortest side of the boxes (m) is below 10 cm.
RestingLengths resting_lengths(double shortest_side);

/// A rigid box in the world's axes, computed once for all pairs that it is in.
struct PlacedBox {
  OrientedBox box;
  Bounds bounds;
};

PlacedBox placed_box(const RigidBox& box);

/// A soft body's surface, likewise.
struct SurfaceColumns {
  TriangleColumns triangles;
  VertexColumns vertices;

  void fill(const SurfaceView& surface, const Bounds& bounds) {
    triangles.fill(surface, bounds);
    vertices.fill(surface.positions, bounds);
  }
};

// Each appends to `contacts`. Indices are those of World::soft and World::rigid; `boxes` are those
// of World::rigid.

/// Vertices below the plane z = 0 (3.1.4).
void find_soft_ground(const World& world, int soft, std::vector<Contact>& contacts);

/// Corners below the plane z = 0, or within the speculative margin above it (ERRATA rows 34 and
/// 63).
void find_rigid_ground(std::span<const PlacedBox> boxes, int rigid, std::vector<Contact>& contacts);

/// Vertices of the soft body inside the box, then corners of the box inside the soft body. Each is
/// to come out through the nearest face or triangle (ERRATA rows 22, 49, 50); as printed, to move
/// that way by the skin thickness. `columns` filled from
/// the soft body's surface.
void find_soft_rigid(const World& world, std::span<const PlacedBox> boxes, int soft, int rigid,
                     const SurfaceColumns& columns, std::vector<Contact>& contacts);

/// The points in which two boxes touch along their axis of minimal penetration.
void find_rigid_rigid(std::span<const PlacedBox> boxes, int first, int second,
                      std::vector<Contact>& contacts);

// The same between boxes and the ground as printed: a pair of bodies collides once, at the middle
// of its points, as deeply as the deepest, without a margin (ERRATA rows 18, 34, 63 and 68).
void find_printed_rigid_ground(std::span<const PlacedBox> boxes, int rigid,
                               std::vector<Contact>& contacts);
void find_printed_rigid_rigid(std::span<const PlacedBox> boxes, int first, int second,
                              std::vector<Contact>& contacts);

}  // namespace pneuma::sim
