// Models on their way from one process to another of the same program.
#pragma once

#include <string>
#include <string_view>

#include "assets/model.h"

namespace pneuma::assets {

/// Names must have no line breaks.
std::string serialise(const Model& model);

/// Throws ModelError when the text is not what serialise makes.
Model deserialise(std::string_view text);

}  // namespace pneuma::assets
