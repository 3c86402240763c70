// The only file that includes osmesa.h. Mesa 25.1 removes OSMesa: egl.cpp does without.
#include <GL/osmesa.h>
#include <fmt/format.h>

#include <array>

#include "render/context/backend_library.h"
#include "render/context/shared_library.h"

namespace pneuma::render {
namespace {

struct Osmesa {
  SharedLibrary library{"libOSMesa.so.8", "libosmesa6"};
  decltype(OSMesaCreateContextAttribs)* create_context =
      library.function<decltype(OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
  decltype(OSMesaDestroyContext)* destroy_context =
      library.function<decltype(OSMesaDestroyContext)>("OSMesaDestroyContext");
  decltype(OSMesaMakeCurrent)* make_current =
      library.function<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent");
  decltype(OSMesaGetCurrentContext)* current_context =
      library.function<decltype(OSMesaGetCurrentContext)>("OSMesaGetCurrentContext");
  decltype(OSMesaGetProcAddress)* find_function =
      library.function<decltype(OSMesaGetProcAddress)>("OSMesaGetProcAddress");
};

class OsmesaContext : public BackendContext {
 public:
  OsmesaContext(const Osmesa& osmesa, const ContextOptions& options) : osmesa_(osmesa) {
    // Depth and stencil belong to the framebuffer objects.
    const std::array<int, 12> attributes = {OSMESA_FORMAT,
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
                                            0};
    context_ = osmesa_.create_context(attributes.data(), nullptr);
    if (context_ != nullptr) return;
    throw GlError(GlFailure::context_refused,
                  fmt::format("OSMesa made no context for the OpenGL {}.{} core profile; install "
                              "libosmesa6 with Mesa 17 to 25.0, and unset MESA_* and GALLIUM_* "
                              "variables in the environment",
                              options.major, options.minor));
  }
  ~OsmesaContext() override {
    if (osmesa_.current_context() == context_) {
      osmesa_.make_current(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
    }
    osmesa_.destroy_context(context_);
  }

  void make_current() override {
    if (osmesa_.current_context() == context_) return;
    if (osmesa_.make_current(context_, default_framebuffer_.data(), GL_UNSIGNED_BYTE, 1, 1) !=
        GL_TRUE) {
      throw GlError(GlFailure::context_refused,
                    "OSMesa would not make its context current; use a renderer only on the thread "
                    "that made it");
    }
  }

 private:
  const Osmesa& osmesa_;
  OSMesaContext context_ = nullptr;
  // OSMesa insists on a default framebuffer and copies it at each flush; nothing is drawn to it.
  std::array<std::uint8_t, 4> default_framebuffer_ = {};
};

class OsmesaLibrary : public BackendLibrary {
 public:
  Backend backend() const override { return Backend::osmesa; }
  std::unique_ptr<BackendContext> make_context(const ContextOptions& options) override {
    return std::make_unique<OsmesaContext>(osmesa_, options);
  }
  GlFunction find_function(const char* name) const override { return osmesa_.find_function(name); }

 private:
  Osmesa osmesa_;
};

}  // namespace

std::unique_ptr<BackendLibrary> open_osmesa() { return std::make_unique<OsmesaLibrary>(); }

}  // namespace pneuma::render
