#include "app/files/find_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <system_error>

#include "app/files/data_folders.h"
#include "assets/model_file.h"
#include "scenes/loader/load_scene.h"
#include "sim/base/nearest.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && !fs::is_directory(path, ignored);
}

std::vector<std::string> names_in(const std::vector<fs::path>& folders) {
  std::vector<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
  }
  return names;
}

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw scenes::SceneError({{.file = name, .message = why}});
}

bool has_other_ending(const fs::path& path) {
  const std::string ending = path.extension().string();
  const bool is_scene = ending.empty() || ending == ".toml" || ending == ".TOML";
  return !is_scene && !assets::has_model_ending(path);
}

std::string known_endings(const fs::path& path) {
  return fmt::format("the ending '{}' is neither that of a scene, .toml, nor of a model: {}",
                     path.extension().string(), assets::model_endings());
}

/// "; did you mean 'good.toml'?", a file that is there; empty: there is none.
std::string suggested_file(const std::string& name) {
  const std::string file = name + ".toml";
  return is_file(file) ? fmt::format("; did you mean {}?", base::in_quotes(file)) : "";
}

/// Of those in the folders of scenes; empty: there is none of that name.
fs::path scene_of_name(const fs::path& given) {
  if (given.has_parent_path()) return {};
  for (const fs::path& folder : scene_folders()) {
    for (const fs::path& name : {given, fs::path(given).concat(".toml")}) {
      if (is_file(folder / name)) return folder / name;
    }
  }
  return {};
}

/// What exists is meant, also a folder: reading it then says what is wrong with it.
void check_kind(const std::string& name) {
  std::error_code ignored;
  if (fs::is_directory(name, ignored) && fs::exists(fs::path(name) / "run.json", ignored)) {
    refuse(name,
           "is the folder of a run; name the scene that it is of, or its file, whose text is "
           "scene_toml in run.json" +
               suggested_file(name));
  }
  if (fs::is_regular_file(name, ignored) && has_other_ending(name)) {
    refuse(name, known_endings(name));
  }
}

[[noreturn]] void not_found(const std::string& name) {
  const std::string file = suggested_file(name);
  if (!file.empty()) refuse(name, "no such file or scene" + file);
  const std::vector<fs::path> folders = scene_folders();
  const std::vector<std::string> names = names_in(folders);
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  std::vector<std::string> searched;
  for (const fs::path& folder : folders) searched.push_back(folder.string());
  refuse(name,
         fmt::format("no such file, and no scene of that name in {}; `pneuma list` shows all "
                     "scenes{}{}",
                     searched.empty() ? "./scenes" : fmt::format("{}", fmt::join(searched, " or ")),
                     base::suggestion(fs::path(name).stem().string(), candidates),
                     has_other_ending(name) ? "; " + known_endings(name) : ""));
}

}  // namespace

std::vector<fs::path> scene_folders() {
  std::vector<fs::path> folders;
  add_folder(folders, "scenes");
  for (const fs::path& folder : data_folders("scenes")) add_folder(folders, folder);
  return folders;
}

fs::path find_scene(const std::string& name_or_path) {
  std::error_code ignored;
  // A folder is none, and may well be that of the scene's frames.
  if (!is_file(name_or_path)) {
    if (const fs::path named = scene_of_name(name_or_path); !named.empty()) return named;
  }
  if (!fs::exists(name_or_path, ignored)) not_found(name_or_path);
  check_kind(name_or_path);
  return name_or_path;
}

}  // namespace pneuma::app
