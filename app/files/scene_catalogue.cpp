#include "app/files/scene_catalogue.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <system_error>

#include "app/files/data_folders.h"
#include "app/files/find_scene.h"
#include "scenes/loader/load_scene.h"

namespace pneuma::app {
namespace {

// Section 6.3's list from top to bottom, then sections 6.4 and 6.5.
constexpr std::array<std::string_view, 13> paper_order = {
    "one_sphere",          "one_torus",           "two_spheres",
    "two_spheres_contact", "three_spheres",       "three_spheres_contact",
    "sphere_in_torus",     "torus_four_cubes",    "pressure_firm",
    "pressure_soft",       "torus_three_spheres", "torus_three_spheres_four_cubes",
    "cat_on_sphere",
};

CatalogueEntry make_entry(const scenes::SceneInfo& info) {
  CatalogueEntry entry{.path = info.path,
                       .name = info.name,
                       .title = info.title,
                       .figure = info.figure,
                       .paper_fps = std::nullopt,
                       .has_flow_or_springs = info.has_flow_or_springs,
                       .error = info.error};
  if (info.error.empty()) entry.paper_fps = scenes::load_scene(info.path).paper_fps;
  return entry;
}

[[noreturn]] void fail(const char* message) {
  scenes::Diagnostic diagnostic;
  diagnostic.file = "scenes";
  diagnostic.message = message;
  throw scenes::SceneError({diagnostic});
}

}  // namespace

std::vector<CatalogueEntry> scene_catalogue() {
  const std::vector<std::filesystem::path> folders = scene_folders();
  if (folders.empty()) {
    fail(
        "there is no folder of scenes here, beside the program, or in pneuma/ of the XDG data "
        "folders; install pneuma again, or name scene files");
  }
  std::map<std::string, CatalogueEntry> entries;
  for (const auto& folder : folders) {
    for (const scenes::SceneInfo& info : scenes::list_scenes(folder)) {
      if (!entries.contains(info.name)) entries.emplace(info.name, make_entry(info));
    }
  }
  std::vector<CatalogueEntry> sorted;
  for (auto& [name, entry] : entries) sorted.push_back(std::move(entry));
  return sorted;
}

std::vector<std::filesystem::path> scenes_of_the_paper() {
  std::vector<CatalogueEntry> entries = scene_catalogue();
  std::erase_if(entries, [](const CatalogueEntry& entry) { return !entry.paper_fps; });
  if (entries.empty())
    fail("no scene here has a paper_fps to compare with; name the scenes to measure");
  // A scene that the list does not know comes last.
  std::ranges::stable_sort(entries, {}, [](const CatalogueEntry& entry) {
    return std::ranges::find(paper_order, entry.name) - paper_order.begin();
  });
  std::vector<std::filesystem::path> paths;
  for (const CatalogueEntry& entry : entries) paths.push_back(entry.path);
  return paths;
}

std::vector<std::string> sweep_names() {
  std::set<std::string> names;
  for (const std::filesystem::path& folder : data_folders("scenes/sweeps")) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
      if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace pneuma::app
