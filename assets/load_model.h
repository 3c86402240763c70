// A model file into a mesh for a soft body.
#pragma once

#include <filesystem>

#include "assets/clean_mesh.h"
#include "assets/import_model.h"

namespace pneuma::assets {

/// import_model, then clean_mesh. Throws ModelError, whose message begins with the path.
CleanModel load_model(const std::filesystem::path& path, const CleanOptions& options = {});

}  // namespace pneuma::assets
