// Sweep files: strict TOML into a Sweep.
#pragma once

#include <filesystem>
#include <string>

#include "app/sweep/sweep.h"

namespace pneuma::app {

/// Reads a sweep file and looks that its scenes can be loaded with what is varied. A scene is a
/// name, or a path from the sweep's own folder. Throws scenes::SceneError with every error of the
/// file, as file:line:column.
Sweep read_sweep(const std::filesystem::path& path);

/// A path to a file as it is; a name ("stability_map") as that sweep among those that come with the
/// program. Throws scenes::SceneError.
std::filesystem::path find_sweep(const std::string& name_or_path);

/// The reference of all keys of sweep files.
std::string sweep_reference();

}  // namespace pneuma::app
