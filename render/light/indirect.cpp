#include "render/light/indirect.h"

#include <algorithm>

namespace pneuma::render {

void IndirectLighting::take_bodies(const std::vector<Mesh>& meshes, const Vec3f& to_light,
                                   const IsLit& is_lit, bool on_ground) {
  std::erase_if(shapes_, [](const auto& entry) { return entry.first.expired(); });
  bodies_.clear();
  for (const Mesh& mesh : meshes) {
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
  light.resize(surface.positions().size());
  for (const LitMesh& mesh : surface.lit_meshes()) {
    for (std::size_t done = 0; done < mesh.count; done += Receivers::most) {
      light_block(surface, mesh.first + done, std::min(Receivers::most, mesh.count - done),
                  floor_left, light);
    }
  }
}

void IndirectLighting::light_block(const DrawnSurface& surface, std::size_t first,
                                   std::size_t count, const FloorLeft& floor_left,
                                   std::vector<IndirectLight>& light) {
  receivers_.begin(count);
  for (std::size_t i = first; i < first + count; ++i) {
    receivers_.add(surface.positions()[i], surface.normals()[i]);
  }
  gather(bodies_, receivers_);
  for (std::size_t i = 0; i < count; ++i) {
    IndirectLight& left = light[first + i];
    left = left_at(receivers_, i);
    if (floor_left) {
      left.open_to.y() *= floor_left(surface.positions()[first + i], surface.normals()[first + i]);
    }
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
