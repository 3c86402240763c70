// The pictures of one run of a sweep, by `pneuma render`.
#pragma once

#include <filesystem>
#include <string>

#include "app/sweep/sweep.h"

namespace pneuma::app {

/// Where the pictures of a run lie.
std::filesystem::path picture_folder(const std::filesystem::path& folder, std::int64_t run);

/// Of all runs, and nothing else that lies beside them.
void remove_pictures(const std::filesystem::path& folder);

/// Draws them into `into`, from where that was interrupted if it was. `frames`: as --frames has it;
/// empty: all. By a process of its own, because drawing loads LLVM, which would stay. Throws
/// base::IoError with its last words, and Interrupted.
void render_run(const Sweep& sweep, const SweepRun& run, const std::string& frames,
                const std::filesystem::path& into);

}  // namespace pneuma::app
