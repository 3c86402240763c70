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

/// Instances in GL's memory, each drawn as four corners of a strip. Its attributes are at the
/// locations 0, 1, ...
template <class Instance>
class InstanceBuffer {
 public:
  explicit InstanceBuffer(const std::vector<InstanceAttribute>& attributes) {
    glBindVertexArray(vertex_array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
    GLuint location = 0;
    for (const InstanceAttribute& attribute : attributes) {
      set_attribute(location++, attribute.components, sizeof(Instance), attribute.offset, 1);
    }
  }

  /// With the program in use, over the layer where `depth_test` lets them; hides nothing that comes
  /// later.
  void draw(const std::vector<Instance>& instances, GLenum depth_test) {
    blend_over_layer();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(depth_test);
    glDepthMask(GL_FALSE);
    glBindVertexArray(vertex_array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(Instance)),
                 instances.data(), GL_STREAM_DRAW);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances.size()));
  }

 private:
  Vao vertex_array_;
  Buffer instances_;
};

/// Instances with the program that draws them. Its shaders have the uniforms `view`, `projection`,
/// `picture_size` and `opacity`.
template <class Instance>
class InstancedQuads {
 public:
  InstancedQuads(std::string_view name, std::string_view vertex_source,
                 std::string_view fragment_source, const std::vector<InstanceAttribute>& attributes)
      : program_(name, "", vertex_source, fragment_source),
        view_(program_.uniform("view")),
        projection_(program_.uniform("projection")),
        picture_size_(program_.uniform("picture_size")),
        opacity_(program_.uniform("opacity")),
        instances_(attributes) {}

  void begin(const View& view) {
    program_.use();
    set_uniform(view_, view.view);
    set_uniform(projection_, view.projection);
    set_uniform(picture_size_, picture_size(view));
  }

  /// After begin().
  void draw(const std::vector<Instance>& instances, GLenum depth_test, float opacity) {
    set_uniform(opacity_, opacity);
    instances_.draw(instances, depth_test);
  }

  const Program& program() const { return program_; }

 private:
  Program program_;
  GLint view_;
  GLint projection_;
  GLint picture_size_;
  GLint opacity_;
  InstanceBuffer<Instance> instances_;
};

}  // namespace pneuma::render
