// Models on their way from one process to another of the same program.
#pragma once

#include <string>
#include <string_view>

#include "assets/model.h"

namespace pneuma::assets {

/// Names must have no line breaks.
std::string pack(const Model& model);

/// Throws ModelError when the text is not what pack makes.
Model unpack(std::string_view text);

}  // namespace pneuma::assets
