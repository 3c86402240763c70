// Where the scenes and models that come with the program lie.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace pneuma::app {

/// The folders of that name ("scenes", "assets") that exist, in the order in which they are
/// searched: share/pneuma beside the folder of the executable, or the source tree around it when it
/// lies where it was built; pneuma in the XDG data folders; the source tree it was built from.
std::vector<std::filesystem::path> data_folders(std::string_view name);

/// The same for a program, or a Python module (NAME.so), that lies at `executable`.
std::vector<std::filesystem::path> data_folders(std::string_view name,
                                                const std::filesystem::path& executable);

/// Adds a folder that exists, unless it is among them under this or another name.
void add_folder(std::vector<std::filesystem::path>& folders, const std::filesystem::path& folder);

}  // namespace pneuma::app
