#include "app/files/find_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <system_error>
#include <vector>

#include "app/files/data_folders.h"
#include "app/files/refuse_body.h"
#include "app/host/interrupt.h"
#include "assets/load_model.h"
#include "assets/model_file.h"
#include "scenes/loader/text_checks.h"
#include "sim/base/nearest.h"

namespace pneuma::app {

namespace fs = std::filesystem;

namespace {

/// Names in a message.
constexpr std::size_t most_models = 10;

/// "; did you mean 'pear.ply'?", of the models in the folders, or nothing. If there are, those
/// whose names go on where this one ends: cat_500.ply for cat.ply.
std::string near_name(const std::string& name, const std::vector<fs::path>& folders) {
  std::set<std::string> files;  // in one order, whatever the disk's
  for (const fs::path& folder : folders) {
    std::error_code error;
    const fs::path listed = folder.empty() ? fs::path(".") : folder;
    for (auto entry = fs::directory_iterator(listed, error);
         !error && entry != fs::directory_iterator(); entry.increment(error)) {
      if (assets::has_model_ending(entry->path())) files.insert(entry->path().filename().string());
    }
  }
  const std::string stem = fs::path(name).stem().string();
  std::vector<std::string_view> longer;
  for (const std::string& file : files) {
    const bool goes_on = !stem.empty() && file.starts_with(stem);
    if (goes_on && longer.size() < most_models) longer.push_back(file);
  }
  if (!longer.empty()) return fmt::format("; there are: {}", fmt::join(longer, ", "));
  return base::suggestion(name, {files.begin(), files.end()});
}

/// Each folder once, however it is written.
std::vector<fs::path> without_repetition(const std::vector<fs::path>& folders) {
  std::vector<fs::path> once;
  std::set<fs::path> known;
  for (const fs::path& folder : folders) {
    std::error_code error;
    const fs::path real = fs::weakly_canonical(fs::absolute(folder / ".", error), error);
    if (known.insert(real).second) once.push_back(folder);
  }
  return once;
}

}  // namespace

fs::path find_model(const std::string& file, const fs::path& scene_folder) {
  const fs::path path(file);
  if (path.is_absolute()) return path;
  std::vector<std::string> searched;
  std::vector<fs::path> folders = {scene_folder, fs::path(), fs::path("assets")};
  for (const fs::path& folder : data_folders("assets")) folders.push_back(folder);
  folders = without_repetition(folders);
  for (const fs::path& folder : folders) {
    std::error_code ignored;
    const fs::path candidate = folder / path;
    if (fs::exists(candidate, ignored)) return candidate;
    // The folder that a scene is to be kept in may be missing yet.
    const fs::path without_folder = fs::weakly_canonical(candidate, ignored);
    if (fs::exists(without_folder, ignored)) return without_folder;
    searched.push_back(candidate.string());
  }
  throw assets::ModelError(fmt::format("{}: no such model file; looked for {}{}", file,
                                       fmt::join(searched, ", "),
                                       near_name(path.filename().string(), folders)));
}

std::string model_name_from(const fs::path& folder, const fs::path& model) {
  if (model.is_relative()) return model.string();
  constexpr std::ptrdiff_t max_climb = 2;
  // Links are followed, but not the model's own: ".." leaves the folder that a link leads to.
  std::error_code unreadable;  // then a path is empty, and nothing relative to it
  fs::path from = fs::weakly_canonical(fs::absolute(folder), unreadable);
  if (!from.has_filename()) from = from.parent_path();  // "out/"
  const fs::path place = fs::weakly_canonical(model.parent_path(), unreadable);
  const fs::path relative = (place / model.filename()).lexically_relative(from);
  const std::ptrdiff_t climb = std::ranges::count(relative, fs::path(".."));
  const fs::path below_root = from.relative_path();
  const bool is_near =
      climb <= max_climb && climb < std::distance(below_root.begin(), below_root.end());
  if (relative.empty() || !is_near) return model.string();
  // A folder that a link leads to may have a name that scene files cannot say.
  return scenes::check_file(relative.string()).empty() ? relative.string() : model.string();
}

namespace {

/// Throws assets::ModelError.
sim::TriangleMesh load_mesh(const scenes::Scene& scene, const scenes::BodyScene& body) {
  assets::CleanOptions options;
  options.component = body.model.component;
  options.scale = body.model.scale;
  options.rotation = body.model.rotation;
  options.centre = body.model.centre;
  options.repair = body.model.repair;
  options.simplify_to = body.model.vertices;
  options.most_vertices = scene.limits.vertices_per_body;
  const auto most_bytes = static_cast<std::size_t>(scene.limits.model_file_mib * 1024.0 * 1024.0);
  try {
    return assets::load_model(find_model(body.model.file, scene.folder), options, most_bytes).mesh;
  } catch (const assets::ModelError&) {
    throw_if_interrupted();  // Ctrl-C ends the importer first
    throw;
  }
}

}  // namespace

sim::TriangleMesh load_model_mesh(const scenes::Scene& scene, const scenes::BodyScene& body) {
  try {
    return load_mesh(scene, body);
  } catch (const assets::ModelError& error) {
    refuse_body(scene, body.model_place, body.name, error.what());
  }
}

std::string model_error(const scenes::Scene& scene, const scenes::BodyScene& body) {
  try {
    load_mesh(scene, body);
    return {};
  } catch (const assets::ModelError& error) {
    return error.what();
  }
}

}  // namespace pneuma::app
