// The record of a run while it goes on: a file of JSON lines. The first is the header, then one per
// launch and per finished frame. Each is written at once, so that a kill loses at most the last.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "app/record/ordered_json.h"

namespace pneuma::app {

/// What a journal says, up to the first line that is torn or not JSON.
struct JournalContents {
  Json header;
  std::vector<Json> lines;          // after the header
  std::vector<std::uint64_t> ends;  // of each line, in bytes from the file's start
  std::uint64_t header_end = 0;
};

/// Nothing when there is no file or its header is torn. Throws base::IoError when it cannot be
/// read.
std::optional<JournalContents> read_journal(const std::filesystem::path& path);

/// A journal being written. The file is locked meanwhile, so that two runs cannot share a folder.
/// All members throw base::IoError.
class Journal {
 public:
  /// Keeps the first `keep` bytes of what is there: 0 starts a new one.
  Journal(const std::filesystem::path& path, std::uint64_t keep);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  void append(const Json& line);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// Whether a run that is going on writes this journal.
bool is_in_use(const std::filesystem::path& journal);

}  // namespace pneuma::app
