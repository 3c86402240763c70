#include "render/context/context.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "render/context/backend_library.h"
#include "render/context/load_gl.h"

namespace pneuma::render {

Context::Context(const ContextOptions& options) {
  const char* wish = std::getenv("PNEUMA_GL");
  if (wish != nullptr && std::strcmp(wish, "none") == 0) {
    throw GlError(GlFailure::switched_off,
                  "GL is switched off by PNEUMA_GL=none in the environment; unset PNEUMA_GL");
  }
  BackendLibrary& library = backend_library(options.backend);
  backend_ = library.backend();
  context_ = library.make_context(options);
  make_current();
  report_ = load_gl();
  check_report(report_, options);
}

Context::~Context() = default;

void Context::make_current() { context_->make_current(); }

void check_report(const ContextReport& report, const ContextOptions& options) {
  if (report.major < options.major ||
      (report.major == options.major && report.minor < options.minor)) {
    throw GlError(
        GlFailure::version_too_old,
        fmt::format("OpenGL {}.{} is needed, but '{}' on '{}' was given; install Mesa 17 or newer "
                    "(libosmesa6), and unset MESA_GL_VERSION_OVERRIDE in the environment",
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
// OSMesa (22.3) never frees the default framebuffer of a context that is destroyed, 160 bytes, and
// EGL keeps its displays. With this in whatever makes contexts, the leak checker tells of our own
// leaks alone.
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the checker's name
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa.so\nleak:libEGL\nleak:libGLdispatch\nleak:swrast_dri.so\nleak:libgallium";
}
#endif
