// The folder of a `pneuma render` as something to look at: its record and its pictures.
#pragma once

#include <filesystem>
#include <string>

#include "app/render/log/journal.h"
#include "app/render/log/run_folder.h"

namespace pneuma::app {

struct RecordedRun {
  RunFolder folder;
  Json record;  // as run.json has it; of an unfinished run, as far as it has come

  const Json& frames() const { return record.at("frames"); }
};

/// Throws base::IoError when the folder holds no run, several unfinished ones, or a record that is
/// not one of ours.
RecordedRun read_run(const std::filesystem::path& folder);

}  // namespace pneuma::app
