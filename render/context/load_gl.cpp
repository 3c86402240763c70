#include "render/context/load_gl.h"

#include <fmt/format.h>

#include <cstring>
#include <mutex>

#include "render/context/backend_library.h"
#include "render/context/gl.h"

// Debian's libGLEW is built for GLX and asks these three functions of libGL, which must not be
// linked: ahead of libOSMesa it gives black frames without an error. They stand in for libGL, in
// the same object file as the call of glewInit, so that no linker can leave them out.
extern "C" {

// Names and types are those of glx.h, which would drag in X11.
using GlxFunction = void (*)();

static void* any_display() {
  static int display = 0;
  return &display;
}

GlxFunction glXGetProcAddressARB(const GLubyte* name) {
  const char* wanted = reinterpret_cast<const char*>(name);
  // GLEW gives up on GLX, and on all of GL with it, when there is no display.
  if (std::strcmp(wanted, "glXGetCurrentDisplay") == 0) {
    return reinterpret_cast<GlxFunction>(any_display);
  }
  return pneuma::render::backend_library(std::nullopt).find_function(wanted);
}

int glXQueryVersion(void* /*display*/, int* major, int* minor) {
  *major = 1;
  *minor = 4;
  return 1;
}

const char* glXGetClientString(void* /*display*/, int /*name*/) { return ""; }

}  // extern "C"

namespace pneuma::render {
namespace {

std::string gl_string(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

void load_functions() {
  glewExperimental = GL_TRUE;  // without it GLEW asks for extensions in a way core profiles refuse
  const GLenum status = glewInit();
  glGetError();  // what glewInit itself provoked
  if (status != GLEW_OK) {
    throw GlError(GlFailure::functions_missing,
                  fmt::format("GLEW could not load OpenGL's functions ({}); install libglew-dev "
                              "and libosmesa6 of one Debian release and build again",
                              reinterpret_cast<const char*>(glewGetErrorString(status))));
  }
}

std::array<std::uint8_t, 4> clear_and_read_pixel() {
  GLuint colour = 0;
  GLuint framebuffer = 0;
  glGenRenderbuffers(1, &colour);
  glBindRenderbuffer(GL_RENDERBUFFER, colour);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 1, 1);
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour);

  constexpr float byte = 1.0f / 255.0f;
  glClearColor(probe_colour[0] * byte, probe_colour[1] * byte, probe_colour[2] * byte,
               probe_colour[3] * byte);
  glClear(GL_COLOR_BUFFER_BIT);
  std::array<std::uint8_t, 4> pixel = {};
  glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());

  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDeleteFramebuffers(1, &framebuffer);
  glDeleteRenderbuffers(1, &colour);
  return pixel;
}

}  // namespace

std::string glew_version() { return reinterpret_cast<const char*>(glewGetString(GLEW_VERSION)); }

ContextReport load_gl() {
  // GLEW keeps the functions in globals. They are the same for every context of a backend, so that
  // once is enough, and contexts may be made on several threads.
  static std::once_flag loaded;
  std::call_once(loaded, load_functions);

  ContextReport report;
  report.version = gl_string(GL_VERSION);
  report.renderer = gl_string(GL_RENDERER);
  glGetIntegerv(GL_MAJOR_VERSION, &report.major);
  glGetIntegerv(GL_MINOR_VERSION, &report.minor);
  report.pixel = clear_and_read_pixel();
  return report;
}

}  // namespace pneuma::render
