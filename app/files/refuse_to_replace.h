// What a command finds where it is to write.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pneuma::app {

/// Throws base::IoError that names the file and --overwrite, if it is there. `other_place`: how to
/// write elsewhere, "choose another folder with --out".
void refuse_to_replace(const std::filesystem::path& file, const std::string& other_place);

/// The same of the first of these files that is in the folder.
void refuse_to_replace(const std::filesystem::path& folder, const std::vector<std::string>& files,
                       const std::string& other_place);

}  // namespace pneuma::app
