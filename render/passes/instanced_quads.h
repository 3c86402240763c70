// Quads that face the eye, one per instance; the vertex shader makes the corners from gl_VertexID.
#pragma once

#include <cstddef>
#include <vector>

#include "render/frame/view.h"
#include "render/passes/gl_objects.h"
#include "render/passes/layer.h"
#include "render/passes/program.h"

namespace pneuma::render {

/// Where an instance has one of its values, all of them floats.
struct InstanceAttribute {
  GLint components;
  std::size_t offset;
};

/// The program and the buffer of what is drawn so, over the layer. Its shaders have the uniforms
/// `view`, `projection`, `picture_size` and `opacity`, and an instance's attributes at the
/// locations 0, 1, ...
template <class Instance>
class InstancedQuads {
 public:
  InstancedQuads(std::string_view name, std::string_view vertex_source,
                 std::string_view fragment_source, const std::vector<InstanceAttribute>& attributes)
      : program_(name, "", vertex_source, fragment_source),
        view_(program_.uniform("view")),
        projection_(program_.uniform("projection")),
        picture_size_(program_.uniform("picture_size")),
        opacity_(program_.uniform("opacity")) {
    glBindVertexArray(vertex_array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
    GLuint location = 0;
    for (const InstanceAttribute& attribute : attributes) {
      set_attribute(location++, attribute.components, sizeof(Instance), attribute.offset, 1);
    }
  }

  /// Binds everything; nothing that is drawn then hides what comes later.
  void begin(const View& view) {
    blend_over_layer();
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    program_.use();
    set_uniform(view_, view.view);
    set_uniform(projection_, view.projection);
    set_uniform(picture_size_,
                Eigen::Vector2f(static_cast<float>(view.width), static_cast<float>(view.height)));
    glBindVertexArray(vertex_array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  }

  /// After begin(): where `depth_test` lets them.
  void draw(const std::vector<Instance>& instances, GLenum depth_test, float opacity) {
    glDepthFunc(depth_test);
    set_uniform(opacity_, opacity);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(Instance)),
                 instances.data(), GL_STREAM_DRAW);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances.size()));
  }

  const Program& program() const { return program_; }

 private:
  Vao vertex_array_;
  Buffer instances_;
  Program program_;
  GLint view_;
  GLint projection_;
  GLint picture_size_;
  GLint opacity_;
};

}  // namespace pneuma::render
