// Loads GL's functions for the current context. Between context.cpp and load_gl.cpp because the
// backends' headers and glew.h cannot share a file.
#pragma once

#include <string>

#include "render/context/context.h"

namespace pneuma::render {

/// "2.2.0". Needs no context.
std::string glew_version();

/// Throws GlError(functions_missing).
ContextReport load_gl();

}  // namespace pneuma::render
