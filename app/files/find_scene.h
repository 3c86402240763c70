// Scenes by name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pneuma::app {

/// The folders that hold scenes, those that exist: ./scenes, then those of data_folders.h.
std::vector<std::filesystem::path> scene_folders();

/// A path to a file as it is; a name ("pressure_soft") as that scene in one of the folders.
/// Throws scenes::SceneError that lists the folders and the nearest name.
std::filesystem::path find_scene(const std::string& name_or_path);

}  // namespace pneuma::app
