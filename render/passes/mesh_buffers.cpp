#include "render/passes/mesh_buffers.h"

#include "render/passes/view.h"

namespace pneuma::render {
namespace {

template <typename T>
void upload_once(const Buffer& buffer, GLenum target, const std::vector<T>& data) {
  glBindBuffer(target, buffer.name());
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(),
               GL_STATIC_DRAW);
}

}  // namespace

void MeshBuffers::upload(const std::vector<Mesh>& meshes) {
  forget_dead_shapes();
  while (vaos_.size() < meshes.size()) vaos_.emplace_back();

  staging_.clear();
  for (const Mesh& mesh : meshes) {
    staging_.insert(staging_.end(), mesh.positions.begin(), mesh.positions.end());
    staging_.insert(staging_.end(), mesh.normals.begin(), mesh.normals.end());
  }
  glBindVertexArray(0);
  upload_once(stream_, GL_ARRAY_BUFFER, staging_);

  drawn_.clear();
  std::size_t offset = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const Mesh& mesh = meshes[i];
    glBindVertexArray(0);
    const Shape& shape = shape_of(mesh.shape);
    glBindVertexArray(vaos_[i].name());
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, shape.indices.name());
    glBindBuffer(GL_ARRAY_BUFFER, shape.colours.name());
    set_attribute(2, 3, sizeof(Vec3f), 0);
    glBindBuffer(GL_ARRAY_BUFFER, stream_.name());
    set_attribute(0, 3, sizeof(Vec3f), offset);
    offset += mesh.positions.size() * sizeof(Vec3f);
    // Flat shading reads no normals; any bytes of the stream will do.
    set_attribute(1, 3, sizeof(Vec3f), mesh.normals.empty() ? 0 : offset);
    offset += mesh.normals.size() * sizeof(Vec3f);
    drawn_.push_back({vaos_[i].name(), shape.index_count, !mesh.normals.empty()});
  }
  glBindVertexArray(0);
}

const MeshBuffers::Shape& MeshBuffers::shape_of(const std::shared_ptr<const MeshShape>& shape) {
  const auto known = shapes_.find(shape);
  if (known != shapes_.end()) return known->second;
  Shape& made = shapes_[shape];
  made.index_count = static_cast<GLsizei>(3 * shape->triangles.size());
  upload_once(made.indices, GL_ELEMENT_ARRAY_BUFFER, shape->triangles);
  std::vector<Vec3f> colours;
  colours.reserve(shape->colours.size());
  for (const Colour& colour : shape->colours) colours.push_back(to_linear(colour));
  upload_once(made.colours, GL_ARRAY_BUFFER, colours);
  return made;
}

void MeshBuffers::forget_dead_shapes() {
  std::erase_if(shapes_, [](const auto& entry) { return entry.first.expired(); });
}

}  // namespace pneuma::render
