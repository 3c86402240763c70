#include "render/context/shared_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "render/context/context.h"

namespace pneuma::render {
namespace {

[[noreturn]] void missing(const std::string& package) {
  throw GlError(GlFailure::library_missing,
                fmt::format("OpenGL's library cannot be used: {}; install it with "
                            "`sudo apt-get install {}`",
                            dlerror(), package));
}

}  // namespace

SharedLibrary::SharedLibrary(const std::string& file, const std::string& package)
    : handle_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)), package_(package) {
  if (handle_ == nullptr) missing(package_);
}

void* SharedLibrary::find(const char* name) const {
  void* function = dlsym(handle_, name);
  if (function == nullptr) missing(package_);
  return function;
}

}  // namespace pneuma::render
