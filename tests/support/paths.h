// Where the files of this checkout and of its build are.
#pragma once

#include <filesystem>
#include <string>

namespace pneuma {

/// All absolute. They are compiled into one source, so that a compiler cache that another checkout
/// filled has all other objects of the tests.
std::filesystem::path project_folder();
std::filesystem::path build_folder();
/// The program `pneuma`.
std::string program_file();

}  // namespace pneuma
