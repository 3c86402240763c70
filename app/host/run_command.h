// Other programs, run to their end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pneuma::app {

/// Runs a command without a shell, its standard output closed, in `folder` where one is given. The
/// first argument is the program's own name. Throws base::IoError with the last line that the
/// command said when it fails, and Interrupted.
void run_command(const std::string& program, const std::vector<std::string>& arguments,
                 const std::filesystem::path& folder = {});

}  // namespace pneuma::app
