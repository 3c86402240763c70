// One component of several.
#pragma once

#include <string>
#include <vector>

#include "assets/clean_mesh.h"

namespace pneuma::assets {

/// The index of the component to keep: the one of that name or number, or, when `wanted` is empty,
/// the only one, or the only closed one. Throws ModelError that lists the components.
int choose_component(const std::vector<Component>& components, const std::string& wanted);

}  // namespace pneuma::assets
