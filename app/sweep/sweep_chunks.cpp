#include "app/sweep/sweep_chunks.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <span>
#include <system_error>

#include "app/host/errors.h"
#include "app/study/study_folder.h"
#include "app/terminal/table.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

nlohmann::ordered_json chunk_json(const std::string& fingerprint, const RunRange& range,
                                  const SweepRows& rows) {
  nlohmann::ordered_json json = {{"sweep", fingerprint},
                                 {"first", range.first},
                                 {"last", range.last},
                                 {"rows", nlohmann::ordered_json::array()}};
  for (const auto& [number, row] : rows) json["rows"].push_back(row_json(row));
  return json;
}

nlohmann::ordered_json read_chunk(const fs::path& path, const std::string& fingerprint) {
  const std::string text = base::read_text_file(path.string());
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("rows")) {
    throw base::IoError(fmt::format("{}: this is no chunk of a sweep; remove it", path.string()));
  }
  if (json.value("sweep", "") == fingerprint) return json;
  throw base::IoError(fmt::format(
      "{}: its rows are of another sweep file, other scenes or another build of the program; "
      "remove it and run the chunk again",
      path.string()));
}

void require_all(const Sweep& sweep, const fs::path& folder, const SweepRows& rows) {
  const std::int64_t count = run_count(sweep);
  const std::int64_t lacking = count - std::ssize(rows);
  if (lacking == 0) return;
  RunRange missing{0, count - 1};
  while (rows.contains(missing.first)) ++missing.first;
  const auto next = rows.upper_bound(missing.first);
  if (next != rows.end()) missing.last = next->first - 1;
  throw base::IoError(fmt::format(
      "{} of {} {} missing in {}, the first of them {}; make them with: pneuma sweep {} --jobs {} "
      "--out {}",
      lacking, counted(count, "run"), lacking == 1 ? "is" : "are", (folder / "chunks").string(),
      range_text(missing), sweep.file.string(), range_text(missing), folder.string()));
}

}  // namespace

std::int64_t parse_count(std::string_view text, const std::string& whole) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool read = error == std::errc() && end == text.data() + text.size() && !text.empty();
  if (read && number >= 0) return number;
  throw UsageError(fmt::format("--jobs {}: give the first and the last, as 100-199", whole));
}

RunRange parse_runs(const std::string& text, const Sweep& sweep, std::string_view option) {
  const std::size_t dash = text.find('-');
  RunRange range;
  range.first = parse_count(std::string_view(text).substr(0, dash), text);
  range.last = dash == std::string::npos
                   ? range.first
                   : parse_count(std::string_view(text).substr(dash + 1), text);
  const std::int64_t count = run_count(sweep);
  if (range.first <= range.last && range.last < count) return range;
  throw UsageError(
      fmt::format("{} {}: the sweep has {}", option, text,
                  count == 1 ? "run 0 alone" : fmt::format("runs 0 to {}", count - 1)));
}

std::string range_text(const RunRange& range) {
  return fmt::format("{}-{}", range.first, range.last);
}

fs::path chunk_file(const fs::path& folder, const RunRange& range) {
  return folder / "chunks" / (range_text(range) + ".json");
}

void run_chunk(const Sweep& sweep, const std::string& fingerprint, const RunRange& range,
               const ChunkOptions& options, const fs::path& folder, Progress& progress) {
  const StudyFolder chunks(folder / "chunks");
  const fs::path path = chunk_file(folder, range);
  SweepJournal journal(chunks.path() / (range_text(range) + ".journal"), fingerprint,
                       ExistingRun::resume);
  run_sweep(sweep, range, options.threads, options.pictures ? folder : fs::path(), journal,
            progress);
  for (const auto& [number, row] : journal.rows()) {
    if (is_to_be_repeated(row)) {
      throw base::IoError(fmt::format("run {}: {}; run the chunk again", number, row.words));
    }
  }
  chunks.write(path.filename().string(),
               chunk_json(fingerprint, range, journal.rows()).dump() + '\n');
}

SweepRows gather_chunks(const Sweep& sweep, const std::string& fingerprint,
                        const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder / "chunks", ignored)) {
    if (entry.path().extension() == ".json") paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  SweepRows rows;
  for (const fs::path& path : paths) {
    const nlohmann::ordered_json chunk = read_chunk(path, fingerprint);
    for (const auto& json : chunk["rows"]) {
      SweepRow row = row_of(json);
      const std::int64_t number = row.run;
      if (!rows.emplace(number, std::move(row)).second) {
        throw base::IoError(fmt::format("{}: run {} is in another chunk too; remove one of them",
                                        path.string(), number));
      }
    }
  }
  require_all(sweep, folder, rows);
  return rows;
}

}  // namespace pneuma::app
