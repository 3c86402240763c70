// GL's objects with owners: released when they go out of scope, with their context current.
#pragma once

#include <utility>

#include "render/context/gl.h"

namespace pneuma::render {

/// Owns one GL name. `Create` makes it, `Release` deletes it.
template <GLuint (*Create)(), void (*Release)(GLuint)>
class GlObject {
 public:
  GlObject() : name_(Create()) {}
  ~GlObject() {
    if (name_ != 0) Release(name_);
  }
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  GLuint name() const { return name_; }

 private:
  GLuint name_;
};

namespace gl {

// GLEW's functions are variables, so they cannot be template arguments themselves.
inline GLuint create_buffer() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return name;
}
inline void release_buffer(GLuint name) { glDeleteBuffers(1, &name); }

inline GLuint create_vao() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return name;
}
inline void release_vao(GLuint name) { glDeleteVertexArrays(1, &name); }

inline GLuint create_texture() {
  GLuint name = 0;
  glGenTextures(1, &name);
  return name;
}
inline void release_texture(GLuint name) { glDeleteTextures(1, &name); }

inline GLuint create_sampler() {
  GLuint name = 0;
  glGenSamplers(1, &name);
  return name;
}
inline void release_sampler(GLuint name) { glDeleteSamplers(1, &name); }

inline GLuint create_renderbuffer() {
  GLuint name = 0;
  glGenRenderbuffers(1, &name);
  return name;
}
inline void release_renderbuffer(GLuint name) { glDeleteRenderbuffers(1, &name); }

inline GLuint create_framebuffer() {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  return name;
}
inline void release_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }

}  // namespace gl

using Buffer = GlObject<gl::create_buffer, gl::release_buffer>;
using Vao = GlObject<gl::create_vao, gl::release_vao>;
using Texture = GlObject<gl::create_texture, gl::release_texture>;
using Sampler = GlObject<gl::create_sampler, gl::release_sampler>;
using Renderbuffer = GlObject<gl::create_renderbuffer, gl::release_renderbuffer>;
using Framebuffer = GlObject<gl::create_framebuffer, gl::release_framebuffer>;

/// An offset into a bound buffer, in the type GL wants it.
inline const void* buffer_offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);  // NOLINT: GL's interface
}

/// Declares a float attribute of the bound vertex array, read from the bound buffer.
inline void set_attribute(GLuint location, GLint components, std::size_t stride, std::size_t offset,
                          GLuint divisor = 0) {
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                        buffer_offset(offset));
  glVertexAttribDivisor(location, divisor);
}

}  // namespace pneuma::render
