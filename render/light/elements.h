// Surfaces as a few discs each, which take light from what is near and send their own.
//
// Bunnell, "Dynamic Ambient Occlusion and Indirect Lighting" (GPU Gems 2, 2005, chapter 14): a
// surface is replaced by discs; what a point gets from a disc is its form factor times what the
// disc sends. Where the paper takes a disc a vertex and several passes, here are at most 64 patches
// a body and one pass, with what the discs get estimated (elements_of). Receivers that are near a
// patch see its parts.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "render/geometry/drawn_surface.h"
#include "render/light/environment.h"

namespace pneuma::render {

/// A disc; of a body seen from far away, a ball of that cross section.
struct Element {
  Vec3f centre;
  Vec3f normal;
  float area;        // m^2
  Light3 radiosity;  // over pi, linear
};

/// One body's.
struct BodyElements {
  std::vector<Element> elements;
  std::vector<Element> parts;             // of the elements, one after the other
  std::vector<std::uint32_t> first_part;  // per element; and the number of all parts
  Element whole;        // a ball in its place: a quarter of its area (Cauchy's cross section)
  float radius = 0.0f;  // m about the ball's centre, of all elements
};

/// Triangles in groups of neighbours, at most `most` groups; from the triangles' indices alone, so
/// that a body's patches stay the same while it moves.
std::vector<std::vector<std::uint32_t>> patches(const std::vector<Triangle>& triangles,
                                                std::size_t most);

/// Whether the sun shines on a point.
using IsLit = std::function<bool(const Vec3f& point)>;

inline constexpr std::size_t most_elements = 64;  // of one body

/// Of a mesh with these patches. An element gets the sun where it is lit, and most of sky and
/// floor, about what bodies that lie together leave each other; the rest of what it sees is like
/// itself. The floor is dark where the sun does not reach the ground that the element sees, if
/// there is ground.
BodyElements elements_of(const Mesh& mesh, std::span<const Vec3f> albedo,
                         const std::vector<std::vector<std::uint32_t>>& patches,
                         const Vec3f& to_light, const IsLit& is_lit, bool on_ground);

}  // namespace pneuma::render
