// A shared library that is opened while the program runs.
#pragma once

#include <string>

namespace pneuma::render {

class SharedLibrary {
 public:
  /// Throws GlError(library_missing), which says that `package` has to be installed.
  SharedLibrary(const std::string& file, const std::string& package);

  /// A function whose type is that of `Function`, as declared in the library's header.
  template <typename Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(find(name));
  }

 private:
  void* find(const char* name) const;

  void* handle_;  // never closed: Mesa leaves threads behind
  std::string package_;
};

}  // namespace pneuma::render
