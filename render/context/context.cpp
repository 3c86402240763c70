// The only file that includes osmesa.h. Mesa 25.1 removes OSMesa; what replaces it (EGL without a
// surface) has to be put here and nowhere else.
#include "render/context/context.h"

#include <GL/osmesa.h>
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "render/context/load_gl.h"

namespace pneuma::render {

struct Context::Handle {
  OSMesaContext context = nullptr;
  // OSMesa insists on a default framebuffer and copies it at each flush; nothing is drawn to it.
  std::array<std::uint8_t, 4> default_framebuffer = {};

  ~Handle() {
    if (OSMesaGetCurrentContext() == context) {
      OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
    }
    OSMesaDestroyContext(context);
  }
};

GlFunction find_gl_function(const char* name) { return OSMesaGetProcAddress(name); }

Context::Context(const ContextOptions& options) : handle_(std::make_unique<Handle>()) {
  const char* wish = std::getenv("PNEUMA_GL");
  if (wish != nullptr && std::strcmp(wish, "none") == 0) {
    throw GlError(GlFailure::switched_off,
                  "GL is switched off by PNEUMA_GL=none in the environment; unset PNEUMA_GL");
  }
  // Depth and stencil belong to the framebuffer objects.
  const std::array<int, 13> attributes = {OSMESA_FORMAT,
                                          OSMESA_RGBA,
                                          OSMESA_DEPTH_BITS,
                                          0,
                                          OSMESA_PROFILE,
                                          OSMESA_CORE_PROFILE,
                                          OSMESA_CONTEXT_MAJOR_VERSION,
                                          options.major,
                                          OSMESA_CONTEXT_MINOR_VERSION,
                                          options.minor,
                                          0,
                                          0,
                                          0};
  handle_->context = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (handle_->context == nullptr) {
    throw GlError(GlFailure::context_refused,
                  fmt::format("OSMesa made no context for the OpenGL {}.{} core profile; install "
                              "libosmesa6 with Mesa 17 to 25.0, and unset MESA_* and GALLIUM_* "
                              "variables in the environment",
                              options.major, options.minor));
  }
  make_current();
  report_ = load_gl();
  check_report(report_, options);
}

Context::~Context() = default;

void Context::make_current() {
  if (OSMesaGetCurrentContext() == handle_->context) return;
  if (OSMesaMakeCurrent(handle_->context, handle_->default_framebuffer.data(), GL_UNSIGNED_BYTE, 1,
                        1) != GL_TRUE) {
    throw GlError(GlFailure::context_refused,
                  "OSMesa would not make its context current; use a renderer only on the thread "
                  "that made it");
  }
}

void check_report(const ContextReport& report, const ContextOptions& options) {
  if (report.major < options.major ||
      (report.major == options.major && report.minor < options.minor)) {
    throw GlError(
        GlFailure::version_too_old,
        fmt::format("OpenGL {}.{} is needed, but '{}' on '{}' was given; install libosmesa6 with "
                    "Mesa 17 or newer, and unset MESA_GL_VERSION_OVERRIDE in the environment",
                    options.major, options.minor, report.version, report.renderer));
  }
  if (report.pixel != probe_colour) {
    throw GlError(GlFailure::pixels_wrong,
                  fmt::format("a pixel cleared to ({}) came back as ({}) from '{}' on '{}'; a "
                              "second GL library is in the way: see `ldd` for libGL or libGLX, "
                              "and unset LD_PRELOAD",
                              fmt::join(probe_colour, ", "), fmt::join(report.pixel, ", "),
                              report.version, report.renderer));
  }
}

}  // namespace pneuma::render

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PNEUMA_LEAK_CHECKER
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define PNEUMA_LEAK_CHECKER
#endif

#ifdef PNEUMA_LEAK_CHECKER
// OSMesa (22.3) never frees the default framebuffer of a context that is destroyed, 160 bytes. With
// this in whatever makes contexts, the leak checker tells of our own leaks alone.
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the checker's name
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa.so"; }
#endif
