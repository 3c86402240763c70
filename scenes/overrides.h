// "PATH=VALUE" into a document.
#pragma once

#include <span>
#include <string>

#include "scenes/document.h"

namespace pneuma::scenes {

/// Puts the overrides' values into the document, in their order. A path that leads nowhere is
/// reported here; an unknown key or a bad value is left for the reader to find.
void apply_overrides(std::span<const std::string> overrides, Table& document, Report& report);

}  // namespace pneuma::scenes
