// The libraries that make contexts, behind one interface. Each is opened when the first context is
// made: a program that draws nothing loads neither, nor LLVM with it.
#pragma once

#include <memory>
#include <optional>

#include "render/context/backend.h"
#include "render/context/context.h"

namespace pneuma::render {

using GlFunction = void (*)();

/// A context of one of the libraries. It ends on the thread that made it.
class BackendContext {
 public:
  BackendContext() = default;
  virtual ~BackendContext() = default;
  BackendContext(const BackendContext&) = delete;
  BackendContext& operator=(const BackendContext&) = delete;

  /// Throws GlError(context_refused).
  virtual void make_current() = 0;
};

/// One of the libraries, opened for as long as the process lives.
class BackendLibrary {
 public:
  BackendLibrary() = default;
  virtual ~BackendLibrary() = default;
  BackendLibrary(const BackendLibrary&) = delete;
  BackendLibrary& operator=(const BackendLibrary&) = delete;

  virtual Backend backend() const = 0;
  /// Throws GlError(context_refused).
  virtual std::unique_ptr<BackendContext> make_context(const ContextOptions& options) = 0;
  /// The GL function of that name, or null.
  virtual GlFunction find_function(const char* name) const = 0;
};

/// Both throw GlError(library_missing), which names the Debian package.
std::unique_ptr<BackendLibrary> open_osmesa();
std::unique_ptr<BackendLibrary> open_egl();

/// The library of all contexts of this process. The first call opens the one that is asked for; if
/// none is, OSMesa, or else EGL. GLEW keeps the functions of one library only, so that asking for
/// the other one later throws GlError(context_refused). Throws GlError(library_missing).
BackendLibrary& backend_library(std::optional<Backend> wish);

}  // namespace pneuma::render
