// A model file into a mesh for a soft body.
#pragma once

#include <filesystem>

#include "assets/clean_mesh.h"
#include "assets/import_model.h"

namespace pneuma::assets {

/// import_model, then clean_mesh. Throws ModelError, whose message begins with the path.
/// `most_bytes`: of the model's files together.
CleanModel load_model(const std::filesystem::path& path, const CleanOptions& options = {},
                      std::size_t most_bytes = ImportLimits{}.bytes);

}  // namespace pneuma::assets
