#include "app/sweep/sweep_journal.h"

#include <fmt/format.h>

#include <utility>

#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& what, const char* advice) {
  throw base::IoError(fmt::format("{}: {}; {}", path.string(), what, advice));
}

/// Takes the rows of an earlier launch, and returns the bytes of the file that are whole.
std::uint64_t take_rows(const fs::path& path, const std::string& fingerprint, ExistingRun existing,
                        SweepRows& rows) {
  if (existing == ExistingRun::overwrite) return 0;
  const auto contents = read_journal(path);
  if (!contents) return 0;
  if (existing == ExistingRun::refuse) {
    refuse(path, "there is a sweep already",
           "continue it with --resume, replace it with --overwrite, or choose another folder with "
           "--out");
  }
  if (contents->header.value("sweep", "") != fingerprint) {
    refuse(path, "its rows are of another sweep file, other scenes or another build of the program",
           "replace them with --overwrite, or choose another folder with --out");
  }
  for (const Json& line : contents->lines) {
    SweepRow row = row_of(line);
    if (is_to_be_repeated(row)) continue;
    rows.insert_or_assign(row.run, std::move(row));
  }
  return contents->ends.empty() ? contents->header_end : contents->ends.back();
}

}  // namespace

SweepJournal::SweepJournal(const fs::path& path, const std::string& fingerprint,
                           ExistingRun existing)
    : journal_(path, take_rows(path, fingerprint, existing, rows_)) {
  if (rows_.empty() && fs::file_size(path) == 0) journal_.append({{"sweep", fingerprint}});
}

void SweepJournal::add(SweepRow row) {
  journal_.append(row_json(row));
  rows_.insert_or_assign(row.run, std::move(row));
}

}  // namespace pneuma::app
