#include "app/world/find_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <system_error>
#include <vector>

#include "app/host/interrupt.h"
#include "app/world/data_folders.h"
#include "assets/load_model.h"

namespace pneuma::app {

namespace fs = std::filesystem;

fs::path find_model(const std::string& file, const fs::path& scene_folder) {
  const fs::path path(file);
  if (path.is_absolute()) return path;
  std::vector<std::string> searched;
  std::vector<fs::path> folders = {scene_folder, fs::path(), fs::path("assets")};
  for (const fs::path& folder : data_folders("assets")) folders.push_back(folder);
  for (const fs::path& folder : folders) {
    std::error_code ignored;
    const fs::path candidate = folder / path;
    if (fs::exists(candidate, ignored)) return candidate;
    searched.push_back(candidate.string());
  }
  throw assets::ModelError(
      fmt::format("{}: no such model file; looked for {}", file, fmt::join(searched, ", ")));
}

sim::TriangleMesh load_model_mesh(const scenes::Scene& scene, const scenes::BodyScene& body) {
  assets::CleanOptions options;
  options.component = body.model.component;
  options.scale = body.model.scale;
  options.rotation = body.model.rotation;
  options.centre = body.model.centre;
  options.most_vertices = scene.limits.vertices_per_body;
  const auto most_bytes = static_cast<std::size_t>(scene.limits.model_file_mib * 1024.0 * 1024.0);
  try {
    return assets::load_model(find_model(body.model.file, scene.folder), options, most_bytes).mesh;
  } catch (const assets::ModelError&) {
    throw_if_interrupted();  // Ctrl-C ends the importer first
    throw;
  }
}

}  // namespace pneuma::app
