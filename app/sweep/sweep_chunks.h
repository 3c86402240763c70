// A sweep in parts that machines can take by themselves, and what they leave put together.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/sweep/run_sweep.h"

namespace pneuma::app {

/// "100-199" or "7", of this option. Throws UsageError, also when the sweep has not got them.
RunRange parse_runs(const std::string& text, const Sweep& sweep,
                    std::string_view option = "--jobs");
/// A number at or above 0; `whole` is named in messages. Throws UsageError.
std::int64_t parse_count(std::string_view text, const std::string& whole);
std::string range_text(const RunRange& range);

/// chunks/FIRST-LAST.json: the rows of a finished chunk.
std::filesystem::path chunk_file(const std::filesystem::path& folder, const RunRange& range);

struct ChunkOptions {
  int threads = 1;
  bool pictures = true;  // those that the sweep asks for
};

/// Runs a chunk, from where it was interrupted if it was, and leaves chunk_file. Throws as
/// run_sweep does, and base::IoError when a run is to be repeated.
void run_chunk(const Sweep& sweep, const std::string& fingerprint, const RunRange& range,
               const ChunkOptions& options, const std::filesystem::path& folder,
               Progress& progress);

/// The rows of all finished chunks. Throws base::IoError when runs are missing, with the first
/// command that makes some; when a run is in two chunks; and when a chunk is another sweep's.
SweepRows gather_chunks(const Sweep& sweep, const std::string& fingerprint,
                        const std::filesystem::path& folder);

}  // namespace pneuma::app
