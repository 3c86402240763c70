// The rows of a sweep, or of a chunk of it, while it runs: each is on disk as soon as it is there.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "app/render/log/journal.h"
#include "app/render/log/resume.h"
#include "app/sweep/sweep_row.h"

namespace pneuma::app {

/// By their runs.
using SweepRows = std::map<std::int64_t, SweepRow>;

class SweepJournal {
 public:
  /// Goes on with what is there if that is to be resumed, and takes its rows, but for those that
  /// are to be repeated. Throws base::IoError when the file is another sweep's, is in use, or is
  /// there and not to be resumed.
  SweepJournal(const std::filesystem::path& path, const std::string& fingerprint,
               ExistingRun existing);

  const SweepRows& rows() const { return rows_; }
  /// Throws base::IoError.
  void add(SweepRow row);

 private:
  SweepRows rows_;
  Journal journal_;
};

}  // namespace pneuma::app
