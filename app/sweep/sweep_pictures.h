// The last pictures of a sweep's runs on one page.
#pragma once

#include <optional>
#include <string>

#include "app/study/study_folder.h"
#include "app/sweep/sweep_journal.h"

namespace pneuma::app {

/// NAME_sheet.png: one picture for each run, in their order, the values of the last grid parameter
/// beside each other; grey where a run has none. Of many runs some, evenly chosen. Returns its
/// path; none when the sweep makes no pictures, or no run has one. Throws base::IoError.
std::optional<std::string> write_sweep_sheet(const StudyFolder& folder, const Sweep& sweep,
                                             const SweepRows& rows);

}  // namespace pneuma::app
