#include "tests/support/paths.h"

namespace pneuma {

std::filesystem::path project_folder() { return PNEUMA_PROJECT_FOLDER; }
std::filesystem::path build_folder() { return PNEUMA_BUILD_FOLDER; }
std::string program_file() { return build_folder() / "app/pneuma"; }

}  // namespace pneuma
