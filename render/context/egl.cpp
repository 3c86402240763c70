// The only file that includes EGL's headers. Of all devices Mesa's software device is used: it
// draws by the CPU as OSMesa does, bit for bit, also where there is a graphics card.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <array>
#include <cstring>

#include "render/context/backend_library.h"
#include "render/context/shared_library.h"

namespace pneuma::render {
namespace {

constexpr const char* packages = "libegl1 libgl1-mesa-dri";

struct Egl {
  SharedLibrary library{"libEGL.so.1", packages};
  decltype(eglGetProcAddress)* find_function =
      library.function<decltype(eglGetProcAddress)>("eglGetProcAddress");
  decltype(eglGetPlatformDisplay)* get_display =
      library.function<decltype(eglGetPlatformDisplay)>("eglGetPlatformDisplay");
  decltype(eglInitialize)* initialize = library.function<decltype(eglInitialize)>("eglInitialize");
  decltype(eglBindAPI)* bind_api = library.function<decltype(eglBindAPI)>("eglBindAPI");
  decltype(eglCreateContext)* create_context =
      library.function<decltype(eglCreateContext)>("eglCreateContext");
  decltype(eglDestroyContext)* destroy_context =
      library.function<decltype(eglDestroyContext)>("eglDestroyContext");
  decltype(eglMakeCurrent)* make_current =
      library.function<decltype(eglMakeCurrent)>("eglMakeCurrent");
  decltype(eglGetCurrentContext)* current_context =
      library.function<decltype(eglGetCurrentContext)>("eglGetCurrentContext");
  decltype(eglGetError)* error = library.function<decltype(eglGetError)>("eglGetError");
};

[[noreturn]] void refuse(const Egl& egl, const std::string& what) {
  throw GlError(GlFailure::context_refused,
                fmt::format("EGL {} (error {:#x}); install {}, and unset MESA_*, "
                            "GALLIUM_* and EGL_* variables in the environment",
                            what, egl.error(), packages));
}

EGLDeviceEXT software_device(const Egl& egl) {
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.find_function("eglQueryDevicesEXT"));
  const auto query_string = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
      egl.find_function("eglQueryDeviceStringEXT"));
  std::array<EGLDeviceEXT, 64> devices = {};
  EGLint count = 0;
  if (query_devices == nullptr || query_string == nullptr ||
      query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count) != EGL_TRUE) {
    refuse(egl, "cannot list its devices");
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const char* extensions = query_string(devices[i], EGL_EXTENSIONS);
    if (extensions != nullptr && std::strstr(extensions, "EGL_MESA_device_software") != nullptr) {
      return devices[i];
    }
  }
  refuse(egl, "has no software device among its devices");
}

EGLDisplay open_display(const Egl& egl) {
  EGLDisplay display = egl.get_display(EGL_PLATFORM_DEVICE_EXT, software_device(egl), nullptr);
  if (display == EGL_NO_DISPLAY || egl.initialize(display, nullptr, nullptr) != EGL_TRUE) {
    refuse(egl, "cannot use its software device");
  }
  return display;
}

class EglContext : public BackendContext {
 public:
  EglContext(const Egl& egl, EGLDisplay display, const ContextOptions& options)
      : egl_(egl), display_(display) {
    const std::array<EGLint, 7> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                              options.major,
                                              EGL_CONTEXT_MINOR_VERSION,
                                              options.minor,
                                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                              EGL_NONE};
    if (egl_.bind_api(EGL_OPENGL_API) != EGL_TRUE) refuse(egl_, "knows no OpenGL");  // per thread
    context_ = egl_.create_context(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
    if (context_ == EGL_NO_CONTEXT) {
      refuse(egl_, fmt::format("made no context for the OpenGL {}.{} core profile", options.major,
                               options.minor));
    }
  }
  ~EglContext() override {
    if (egl_.current_context() == context_) {
      egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    egl_.destroy_context(display_, context_);
  }

  void make_current() override {
    if (egl_.current_context() == context_) return;
    if (egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      refuse(egl_, "would not make its context current on this thread");
    }
  }

 private:
  const Egl& egl_;
  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
};

class EglLibrary : public BackendLibrary {
 public:
  Backend backend() const override { return Backend::egl; }
  std::unique_ptr<BackendContext> make_context(const ContextOptions& options) override {
    return std::make_unique<EglContext>(egl_, display_, options);
  }
  GlFunction find_function(const char* name) const override { return egl_.find_function(name); }

 private:
  Egl egl_;
  EGLDisplay display_ = open_display(egl_);
};

}  // namespace

std::unique_ptr<BackendLibrary> open_egl() { return std::make_unique<EglLibrary>(); }

}  // namespace pneuma::render
