#include "render/context/backend_library.h"

#include <fmt/format.h>

#include <mutex>

#include "sim/base/enum_name.h"

namespace pneuma::render {
namespace {

std::unique_ptr<BackendLibrary> open(Backend backend) {
  return backend == Backend::osmesa ? open_osmesa() : open_egl();
}

std::unique_ptr<BackendLibrary> open_first() {
  try {
    return open_osmesa();
  } catch (const GlError& no_osmesa) {
    try {
      return open_egl();
    } catch (const GlError& no_egl) {
      throw GlError(GlFailure::library_missing,
                    fmt::format("{}; nor the other one: {}", no_osmesa.what(), no_egl.what()));
    }
  }
}

}  // namespace

std::string_view to_string(Backend backend) { return base::enum_name(backend_names, backend); }

BackendLibrary& backend_library(std::optional<Backend> wish) {
  static std::mutex mutex;
  static std::unique_ptr<BackendLibrary> opened;
  const std::lock_guard lock(mutex);
  if (!opened) opened = wish ? open(*wish) : open_first();
  if (wish && *wish != opened->backend()) {
    throw GlError(GlFailure::context_refused,
                  fmt::format("contexts of this process are made by {} already, so none can be "
                              "made by {}; start another process for it",
                              to_string(opened->backend()), to_string(*wish)));
  }
  return *opened;
}

}  // namespace pneuma::render
