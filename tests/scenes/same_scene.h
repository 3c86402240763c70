// Scenes compared member by member, without the tables of keys that the printer and the loader
// share.
#pragma once

#include <string>

#include "scenes/loader/scene.h"

namespace pneuma::scenes {

/// The first member in which two scenes differ; empty when they are the same.
std::string difference(const Scene& a, const Scene& b);

}  // namespace pneuma::scenes
