// Loads GL's functions for the current context. Between context.cpp and load_gl.cpp because
// osmesa.h and glew.h cannot share a file.
#pragma once

#include <string>

#include "render/context/context.h"

namespace pneuma::render {

using GlFunction = void (*)();

/// The function of that name in the library that made the context, or null.
GlFunction find_gl_function(const char* name);

/// "2.2.0". Needs no context.
std::string glew_version();

/// Throws GlError(functions_missing).
ContextReport load_gl();

}  // namespace pneuma::render
