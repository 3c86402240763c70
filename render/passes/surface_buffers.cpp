#include "render/passes/surface_buffers.h"

#include <cstddef>

namespace pneuma::render {
namespace {

template <typename T>
void stream(GLenum target, const std::vector<T>& data) {
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(),
               GL_STREAM_DRAW);
}

}  // namespace

SurfaceBuffers::SurfaceBuffers() {
  glBindVertexArray(vao_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  set_attribute(0, 3, sizeof(SurfaceVertex), offsetof(SurfaceVertex, position));
  set_attribute(1, 4, sizeof(SurfaceVertex), offsetof(SurfaceVertex, normal));  // and flatness
  set_attribute(2, 4, sizeof(SurfaceVertex), offsetof(SurfaceVertex, material));
  glBindBuffer(GL_ARRAY_BUFFER, light_.name());
  set_attribute(3, 3, sizeof(IndirectLight), offsetof(IndirectLight, bounced));
  set_attribute(4, 2, sizeof(IndirectLight), offsetof(IndirectLight, open_to));
  set_attribute(5, 4, sizeof(IndirectLight), offsetof(IndirectLight, near_boxes));
  set_attribute(6, 4, sizeof(IndirectLight),
                offsetof(IndirectLight, near_boxes) + sizeof(Eigen::Vector4f));
}

void SurfaceBuffers::upload(const DrawnSurface& surface) {
  glBindVertexArray(vao_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  stream(GL_ARRAY_BUFFER, surface.vertices());
  stream(GL_ELEMENT_ARRAY_BUFFER, surface.triangles());
  index_count_ = static_cast<GLsizei>(3 * surface.triangles().size());
  sunward_count_ = static_cast<GLsizei>(3 * surface.sunward_count());
}

void SurfaceBuffers::upload_light(const std::vector<IndirectLight>& light) {
  glBindBuffer(GL_ARRAY_BUFFER, light_.name());
  stream(GL_ARRAY_BUFFER, light);
}

void SurfaceBuffers::draw() const { draw(0, index_count_); }

void SurfaceBuffers::draw_sunward() const { draw(0, sunward_count_); }

void SurfaceBuffers::draw_averted() const { draw(sunward_count_, index_count_ - sunward_count_); }

void SurfaceBuffers::draw(const TriangleRange& range) const {
  draw(static_cast<GLsizei>(3 * range.first), static_cast<GLsizei>(3 * (range.end - range.first)));
}

void SurfaceBuffers::draw(GLsizei first_index, GLsizei count) const {
  if (count == 0) return;
  glBindVertexArray(vao_.name());
  const std::size_t offset = sizeof(std::uint32_t) * static_cast<std::size_t>(first_index);
  glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, reinterpret_cast<const void*>(offset));
}

}  // namespace pneuma::render
