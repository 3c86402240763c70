// The functions of OpenGL 1.1. GLEW loads only newer ones: these it expects of libGL, which must
// not be linked (load_gl.cpp). Each is looked up in the backend's library when it is called first.
#include <fmt/format.h>

#include "render/context/backend_library.h"
#include "render/context/gl.h"

namespace {

template <typename Function>
Function* load(const char* name) {
  const auto function = pneuma::render::backend_library(std::nullopt).find_function(name);
  if (function == nullptr) {
    throw pneuma::render::GlError(
        pneuma::render::GlFailure::functions_missing,
        fmt::format("OpenGL's library has no function {}; install Mesa (libosmesa6) again", name));
  }
  return reinterpret_cast<Function*>(function);
}

}  // namespace

extern "C" {

void GLAPIENTRY glBindTexture(GLenum target, GLuint texture) {
  static const auto function = load<decltype(glBindTexture)>("glBindTexture");
  function(target, texture);
}
void GLAPIENTRY glBlendFunc(GLenum sfactor, GLenum dfactor) {
  static const auto function = load<decltype(glBlendFunc)>("glBlendFunc");
  function(sfactor, dfactor);
}
void GLAPIENTRY glClear(GLbitfield mask) {
  static const auto function = load<decltype(glClear)>("glClear");
  function(mask);
}
void GLAPIENTRY glClearColor(GLclampf red, GLclampf green, GLclampf blue, GLclampf alpha) {
  static const auto function = load<decltype(glClearColor)>("glClearColor");
  function(red, green, blue, alpha);
}
void GLAPIENTRY glColorMask(GLboolean red, GLboolean green, GLboolean blue, GLboolean alpha) {
  static const auto function = load<decltype(glColorMask)>("glColorMask");
  function(red, green, blue, alpha);
}
void GLAPIENTRY glCullFace(GLenum mode) {
  static const auto function = load<decltype(glCullFace)>("glCullFace");
  function(mode);
}
void GLAPIENTRY glDeleteTextures(GLsizei n, const GLuint* textures) {
  static const auto function = load<decltype(glDeleteTextures)>("glDeleteTextures");
  function(n, textures);
}
void GLAPIENTRY glDepthFunc(GLenum func) {
  static const auto function = load<decltype(glDepthFunc)>("glDepthFunc");
  function(func);
}
void GLAPIENTRY glDepthMask(GLboolean flag) {
  static const auto function = load<decltype(glDepthMask)>("glDepthMask");
  function(flag);
}
void GLAPIENTRY glDisable(GLenum cap) {
  static const auto function = load<decltype(glDisable)>("glDisable");
  function(cap);
}
void GLAPIENTRY glDrawArrays(GLenum mode, GLint first, GLsizei count) {
  static const auto function = load<decltype(glDrawArrays)>("glDrawArrays");
  function(mode, first, count);
}
void GLAPIENTRY glDrawBuffer(GLenum mode) {
  static const auto function = load<decltype(glDrawBuffer)>("glDrawBuffer");
  function(mode);
}
void GLAPIENTRY glDrawElements(GLenum mode, GLsizei count, GLenum type, const void* indices) {
  static const auto function = load<decltype(glDrawElements)>("glDrawElements");
  function(mode, count, type, indices);
}
void GLAPIENTRY glEnable(GLenum cap) {
  static const auto function = load<decltype(glEnable)>("glEnable");
  function(cap);
}
void GLAPIENTRY glGenTextures(GLsizei n, GLuint* textures) {
  static const auto function = load<decltype(glGenTextures)>("glGenTextures");
  function(n, textures);
}
GLenum GLAPIENTRY glGetError() {
  static const auto function = load<decltype(glGetError)>("glGetError");
  return function();
}
void GLAPIENTRY glGetIntegerv(GLenum pname, GLint* params) {
  static const auto function = load<decltype(glGetIntegerv)>("glGetIntegerv");
  function(pname, params);
}
const GLubyte* GLAPIENTRY glGetString(GLenum name) {
  static const auto function = load<decltype(glGetString)>("glGetString");
  return function(name);
}
void GLAPIENTRY glPixelStorei(GLenum pname, GLint param) {
  static const auto function = load<decltype(glPixelStorei)>("glPixelStorei");
  function(pname, param);
}
void GLAPIENTRY glPolygonOffset(GLfloat factor, GLfloat units) {
  static const auto function = load<decltype(glPolygonOffset)>("glPolygonOffset");
  function(factor, units);
}
void GLAPIENTRY glReadBuffer(GLenum mode) {
  static const auto function = load<decltype(glReadBuffer)>("glReadBuffer");
  function(mode);
}
void GLAPIENTRY glReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format,
                             GLenum type, void* pixels) {
  static const auto function = load<decltype(glReadPixels)>("glReadPixels");
  function(x, y, width, height, format, type, pixels);
}
void GLAPIENTRY glScissor(GLint x, GLint y, GLsizei width, GLsizei height) {
  static const auto function = load<decltype(glScissor)>("glScissor");
  function(x, y, width, height);
}
void GLAPIENTRY glStencilFunc(GLenum func, GLint ref, GLuint mask) {
  static const auto function = load<decltype(glStencilFunc)>("glStencilFunc");
  function(func, ref, mask);
}
void GLAPIENTRY glStencilOp(GLenum fail, GLenum zfail, GLenum zpass) {
  static const auto function = load<decltype(glStencilOp)>("glStencilOp");
  function(fail, zfail, zpass);
}
void GLAPIENTRY glTexImage2D(GLenum target, GLint level, GLint internalformat, GLsizei width,
                             GLsizei height, GLint border, GLenum format, GLenum type,
                             const void* pixels) {
  static const auto function = load<decltype(glTexImage2D)>("glTexImage2D");
  function(target, level, internalformat, width, height, border, format, type, pixels);
}
void GLAPIENTRY glTexParameteri(GLenum target, GLenum pname, GLint param) {
  static const auto function = load<decltype(glTexParameteri)>("glTexParameteri");
  function(target, pname, param);
}
void GLAPIENTRY glTexSubImage2D(GLenum target, GLint level, GLint xoffset, GLint yoffset,
                                GLsizei width, GLsizei height, GLenum format, GLenum type,
                                const void* pixels) {
  static const auto function = load<decltype(glTexSubImage2D)>("glTexSubImage2D");
  function(target, level, xoffset, yoffset, width, height, format, type, pixels);
}
void GLAPIENTRY glViewport(GLint x, GLint y, GLsizei width, GLsizei height) {
  static const auto function = load<decltype(glViewport)>("glViewport");
  function(x, y, width, height);
}

}  // extern "C"
