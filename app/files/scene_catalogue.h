// The scenes that come with the program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pneuma::app {

struct CatalogueEntry {
  std::filesystem::path path;
  std::string name;
  std::string title;
  std::string figure;
  std::optional<double> paper_fps;
  bool has_flow_or_springs = false;  // as scenes::SceneInfo
  std::string error;                 // the first one, when the scene is not valid
};

/// All scenes of all scene folders, sorted by name; of two with one name the one that find_scene
/// finds. Throws scenes::SceneError when there is no folder, or it cannot be read.
std::vector<CatalogueEntry> scene_catalogue();

/// Those that the paper gives a frame rate for, in the order of its section 6.3, then its figures.
/// Throws scenes::SceneError as scene_catalogue does, and when there is none.
std::vector<std::filesystem::path> scenes_of_the_paper();

/// Names of the sweeps that come with the program, sorted.
std::vector<std::string> sweep_names();

}  // namespace pneuma::app
