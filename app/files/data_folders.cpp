#include "app/files/data_folders.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>
#include <system_error>

#include "app/host/build_info.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

std::string environment(const char* name, const std::string& otherwise) {
  const char* value = std::getenv(name);
  return value == nullptr || *value == '\0' ? otherwise : value;
}

/// The XDG Base Directory Specification: a relative path is to be ignored.
std::vector<fs::path> xdg_data_folders() {
  const std::string home = environment("HOME", "");
  std::vector<fs::path> folders = {
      environment("XDG_DATA_HOME", home.empty() ? "" : home + "/.local/share")};
  std::istringstream rest(environment("XDG_DATA_DIRS", "/usr/local/share:/usr/share"));
  for (std::string folder; std::getline(rest, folder, ':');) folders.emplace_back(folder);
  std::erase_if(folders, [](const fs::path& folder) { return !folder.is_absolute(); });
  return folders;
}

/// The file that this code was loaded from: the program, or the Python module.
fs::path own_file() {
  static const char inside = 0;
  Dl_info info = {};
  std::error_code ignored;
  if (dladdr(&inside, &info) != 0 && info.dli_fname != nullptr) {
    const fs::path file = info.dli_fname;
    if (file.extension() == ".so") return fs::canonical(file, ignored);
  }
  return fs::read_symlink("/proc/self/exe", ignored);
}

fs::path installed_share(const fs::path& executable) {
  const bool is_module = executable.extension() == ".so";
  return executable.parent_path() /
         (is_module ? PNEUMA_DATA_FROM_MODULE : PNEUMA_DATA_FROM_PROGRAM);
}

/// The source tree of the build that the program lies in, if it lies in one: both may have been
/// moved together.
fs::path source_tree_around(const fs::path& executable) {
  std::error_code ignored;
  for (fs::path folder = executable.parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    if (fs::exists(folder / "CMakeCache.txt", ignored)) {
      return (folder / PNEUMA_SOURCE_FROM_BUILD).lexically_normal();
    }
  }
  return {};
}

}  // namespace

void add_folder(std::vector<fs::path>& folders, const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return;
  const auto same = [&](const fs::path& other) { return fs::equivalent(folder, other, ignored); };
  if (std::ranges::none_of(folders, same)) folders.push_back(folder);
}

std::vector<fs::path> data_folders(std::string_view name, const fs::path& executable) {
  std::vector<fs::path> folders;
  add_folder(folders, (installed_share(executable) / name).lexically_normal());
  const fs::path around = source_tree_around(executable);
  if (!around.empty()) add_folder(folders, around / name);
  for (const fs::path& folder : xdg_data_folders()) add_folder(folders, folder / "pneuma" / name);
  add_folder(folders, fs::path(PNEUMA_SOURCE_FOLDER) / name);
  return folders;
}

std::vector<fs::path> data_folders(std::string_view name) { return data_folders(name, own_file()); }

}  // namespace pneuma::app
