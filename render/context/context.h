// An OpenGL context without a window.
//
// The library pneuma::render defines the functions of GL 1.1 itself (gl_1_1.cpp, glClear say) and
// three of GLX (load_gl.cpp), which call the GL that it opens at run time: a program that links it
// must not link libGL as well, which has functions of the same names.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "render/context/backend.h"

namespace pneuma::render {

/// What was missing when GL could not be had.
enum class GlFailure {
  switched_off,       // the environment says PNEUMA_GL=none
  library_missing,    // neither OSMesa nor EGL is installed, or not the one asked for
  context_refused,    // the library made no context, or would not make it current
  functions_missing,  // GLEW could not load GL's functions
  version_too_old,    // a context, but of an older GL than asked for
  pixels_wrong,       // a cleared pixel came back in another colour
  shader_refused,     // a shader of ours does not compile or link here
};

/// GL cannot be had. what() says why, and what to do.
class GlError : public std::runtime_error {
 public:
  GlError(GlFailure failure, const std::string& message)
      : std::runtime_error(message), failure_(failure) {}
  GlFailure failure() const { return failure_; }

 private:
  GlFailure failure_;
};

struct ContextOptions {
  int major = 3;  // the min. version with a core profile
  int minor = 3;
  std::optional<Backend> backend = std::nullopt;  // none: OSMesa where it is installed, else EGL
};

/// What a new context says of itself, and one pixel cleared to `probe_colour` and read back.
struct ContextReport {
  std::string version;   // GL_VERSION
  std::string renderer;  // GL_RENDERER
  int major = 0;
  int minor = 0;
  std::array<std::uint8_t, 4> pixel = {};
};

class BackendContext;

/// No channel is 0 or 255, so that neither black nor white frames pass.
inline constexpr std::array<std::uint8_t, 4> probe_colour = {51, 102, 153, 204};

/// Throws GlError unless the report is of a context that draws and is new enough.
void check_report(const ContextReport& report, const ContextOptions& options);

/// A GL core profile context of its own, drawn by the CPU (Mesa's llvmpipe), current on the thread
/// that made it. It has no useful default framebuffer: draw into framebuffer objects.
///
/// All contexts of a process are of one backend. Throws GlError. PNEUMA_GL=none in the environment
/// pretends that GL is missing, for trying out what a program does then.
class Context {
 public:
  explicit Context(const ContextOptions& options = {});
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Two contexts may take turns on one thread.
  void make_current();

  const ContextReport& report() const { return report_; }
  Backend backend() const { return backend_; }

 private:
  std::unique_ptr<BackendContext> context_;
  Backend backend_ = Backend::osmesa;
  ContextReport report_;
};

}  // namespace pneuma::render
