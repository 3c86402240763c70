// Frames of a run on one page.
#pragma once

#include <cstdint>
#include <vector>

#include "app/render/log/run_folder.h"
#include "app/terminal/grid_size.h"

namespace pneuma::app {

/// `count` frames evenly from first to last, both among them; all when there are no more than that.
std::vector<std::int64_t> evenly_chosen(std::int64_t first, std::int64_t last, int count);

/// Reads the frames back from their files and writes the page beside them. Throws base::IoError.
void write_contact_sheet(const RunFolder& folder, std::int64_t first, std::int64_t last,
                         GridSize grid);

}  // namespace pneuma::app
