// What a run was started with before.
#pragma once

#include <string>

#include "app/render/log/run_folder.h"

namespace pneuma::app {

/// What a launch says of the video that it is to make: its whole path. Empty: none.
std::string whole_path(const std::string& video);

/// Whether an earlier launch of the folder's run, finished or not, was to make this video.
bool was_to_make(const RunFolder& folder, const std::string& video);

}  // namespace pneuma::app
