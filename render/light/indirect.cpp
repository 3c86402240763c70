#include "render/light/indirect.h"

#include <algorithm>

namespace pneuma::render {

void IndirectLighting::take_bodies(const std::vector<Mesh>& meshes, const Vec3f& to_light,
                                   const IsLit& is_lit, bool on_ground) {
  std::erase_if(shapes_, [](const auto& entry) { return entry.first.expired(); });
  bodies_.clear();
  for (const Mesh& mesh : meshes) {
    if (!mesh.takes_light) continue;
    const Shape& shape = shape_of(mesh.shape);
    std::vector<Vec3f> own;
    for (const Colour& colour : mesh.colours) own.push_back(to_linear(colour));
    bodies_.add(elements_of(mesh, own.empty() ? shape.albedo : own, shape.patches, to_light, is_lit,
                            on_ground));
  }
  bodies_.build();
}

void IndirectLighting::light(const DrawnSurface& surface, const FloorLeft& floor_left,
                             std::vector<IndirectLight>& light) {
  light.assign(surface.positions().size(), IndirectLight{});
  for (const LitMesh& mesh : surface.lit_meshes()) {
    const std::size_t end = mesh.first + mesh.count;
    for (std::size_t first = mesh.first; first < end; first += Receivers::most) {
      seen_.clear();
      for (std::size_t i = first; i < std::min(first + Receivers::most, end); ++i) {
        if (surface.seen()[i]) seen_.push_back(i);
      }
      if (!seen_.empty()) light_block(surface, seen_, floor_left, light);
    }
  }
}

void IndirectLighting::light_block(const DrawnSurface& surface,
                                   std::span<const std::size_t> vertices,
                                   const FloorLeft& floor_left, std::vector<IndirectLight>& light) {
  constexpr std::size_t lanes = 8;  // which are not done one by one
  const std::size_t count = (vertices.size() + lanes - 1) / lanes * lanes;
  receivers_.begin(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t vertex = vertices[std::min(i, vertices.size() - 1)];
    receivers_.add(surface.positions()[vertex], surface.normals()[vertex]);
  }
  gather(bodies_, receivers_);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3f& position = surface.positions()[vertices[i]];
    IndirectLight& left = light[vertices[i]];
    left = left_at(receivers_, i);
    if (floor_left) left.open_to.y() *= floor_left(position, surface.normals()[vertices[i]]);
  }
}

const IndirectLighting::Shape& IndirectLighting::shape_of(
    const std::shared_ptr<const MeshShape>& shape) {
  const auto known = shapes_.find(shape);
  if (known != shapes_.end()) return known->second;
  Shape& made = shapes_[shape];
  for (const Colour& colour : shape->colours) made.albedo.push_back(to_linear(colour));
  made.patches = patches(shape->triangles, most_elements);
  return made;
}

}  // namespace pneuma::render
