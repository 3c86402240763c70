#include "app/world/find_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <system_error>

#include "app/world/data_folders.h"
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

[[noreturn]] void not_found(const std::string& name) {
  const std::vector<fs::path> folders = scene_folders();
  const std::vector<std::string> names = names_in(folders);
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  std::vector<std::string> searched;
  for (const fs::path& folder : folders) searched.push_back(folder.string());
  scenes::Diagnostic diagnostic;
  diagnostic.file = name;
  diagnostic.message =
      fmt::format("no such file, and no scene of that name in {}; `pneuma list` shows all scenes{}",
                  searched.empty() ? "./scenes" : fmt::format("{}", fmt::join(searched, " or ")),
                  base::suggestion(fs::path(name).stem().string(), candidates));
  throw scenes::SceneError({diagnostic});
}

}  // namespace

std::vector<fs::path> scene_folders() {
  std::vector<fs::path> folders;
  add_folder(folders, "scenes");
  for (const fs::path& folder : data_folders("scenes")) add_folder(folders, folder);
  return folders;
}

fs::path find_scene(const std::string& name_or_path) {
  // What exists is meant, also a folder: reading it then says what is wrong with it.
  std::error_code ignored;
  if (fs::exists(name_or_path, ignored)) return name_or_path;
  const fs::path given(name_or_path);
  if (!given.has_parent_path()) {
    for (const fs::path& folder : scene_folders()) {
      for (const fs::path& name : {given, fs::path(given).concat(".toml")}) {
        if (is_file(folder / name)) return folder / name;
      }
    }
  }
  not_found(name_or_path);
}

}  // namespace pneuma::app
