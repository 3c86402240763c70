// The light on surfaces that does not come from the sun.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "render/light/gather.h"

namespace pneuma::render {

/// What is left of the ground's light for a surface at a point.
using FloorLeft = std::function<float(const Vec3f& position, const Vec3f& normal)>;

/// Keeps what follows from a mesh's shape alone.
class IndirectLighting {
 public:
  /// Makes the elements of a frame's bodies.
  void take_bodies(const std::vector<Mesh>& meshes, const Vec3f& to_light, const IsLit& is_lit,
                   bool on_ground);
  const BodyTree& bodies() const { return bodies_; }

  /// One light for each lit vertex of the same frame, of those that are not seen an open one.
  /// `floor_left` is empty without a ground.
  void light(const DrawnSurface& surface, const FloorLeft& floor_left,
             std::vector<IndirectLight>& light);

 private:
  struct Shape {
    std::vector<Vec3f> albedo;  // linear
    std::vector<std::vector<std::uint32_t>> patches;
  };
  using Key = std::weak_ptr<const MeshShape>;

  const Shape& shape_of(const std::shared_ptr<const MeshShape>& shape);
  void light_block(const DrawnSurface& surface, std::span<const std::size_t> vertices,
                   const FloorLeft& floor_left, std::vector<IndirectLight>& light);

  std::map<Key, Shape, std::owner_less<Key>> shapes_;
  BodyTree bodies_;
  Receivers receivers_;
  std::vector<std::size_t> seen_;  // vertices of a block
};

}  // namespace pneuma::render
