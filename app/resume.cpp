#include "app/resume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "app/run_record.h"
#include "render/image/file.h"
#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

std::optional<sim::World> saved_world(const RunFolder& folder, const sim::World& start) {
  if (!fs::exists(folder.state())) return std::nullopt;
  sim::World world = start;
  try {
    sim::load_state(render::read_file(folder.state().string()), world);
  } catch (const sim::CheckpointError&) {
    return std::nullopt;
  }
  return world;
}

bool has_size(const fs::path& file, std::uintmax_t expected) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  return !error && size == expected;
}

/// Whether the line is that of the given frame and its pictures are there as they were written. A
/// file that a power cut left empty has another size.
bool is_whole(const RunFolder& folder, const Json& line, std::int64_t frame) {
  constexpr std::uintmax_t none = 0;
  if (line.value("frame", std::int64_t{-1}) != frame) return false;
  if (!has_size(folder.frame(frame), line.value("png_bytes", none))) return false;
  return !line.contains("overlay_png_bytes") ||
         has_size(folder.overlay(frame), line.value("overlay_png_bytes", none));
}

/// The lines of two scenes that differ, up to three: scenes with the same bodies print alike.
std::string scene_differences(const std::string& then, const std::string& now) {
  std::istringstream old_lines(then), new_lines(now);
  std::string differences;
  int count = 0;
  for (std::string a, b; std::getline(old_lines, a) && std::getline(new_lines, b);) {
    if (a == b) continue;
    if (++count > 3) return differences + "\n  ...";
    differences += fmt::format("\n  was  {}\n  is   {}", a, b);
  }
  return differences;
}

/// Throws unless a run of the identity `now` continues the one of the header `then`.
void require_same_run(const RunFolder& folder, const Json& then, const Json& now,
                      const std::string& scene_now) {
  const Json old = then.value("run", Json::object());
  if (old == now) return;
  std::string differences;
  for (const auto& [key, value] : now.items()) {
    const Json was = old.value(key, Json());
    if (was == value) continue;
    if (key == "fingerprint") {
      differences += "\nthe scene or its settings:";
      differences += scene_differences(then.value("scene_toml", ""), scene_now);
    } else {
      differences += fmt::format("\n{}: was {}, is {}", key, was.dump(), value.dump());
    }
  }
  throw render::IoError(
      fmt::format("the run in {} cannot be continued, because it differs from this one in{}\n"
                  "give the options it was started with, or --overwrite to start anew",
                  folder.path().string(), differences));
}

[[noreturn]] void refuse(const RunFolder& folder, const std::string& holds,
                         const std::string& advice) {
  throw render::IoError(fmt::format("{} holds {}; {}", folder.path().string(), holds, advice));
}

/// A finished run whose pictures have been lost since is not worth the name.
void require_frames(const RunFolder& folder, const Json& record) {
  for (const Json& line : record.value("frames", Json::array())) {
    const std::int64_t frame = line.value("frame", std::int64_t{-1});
    if (is_whole(folder, line, frame)) continue;
    refuse(folder, fmt::format("a finished run of {} without its frame {}", folder.name(), frame),
           "draw it anew with --overwrite");
  }
}

OpenedFolder continue_run(const RunFolder& folder, const Json& identity,
                          const std::string& scene_toml) {
  folder.remove_temporary_files();
  if (auto journal = read_journal(folder.journal())) {
    require_same_run(folder, journal->header, identity, scene_toml);
    return {false, std::move(journal)};
  }
  if (fs::exists(folder.record())) {
    const auto bytes = render::read_file(folder.record().string());
    const Json record = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    require_same_run(folder, record, identity, scene_toml);
    require_frames(folder, record);
    std::error_code ignored;
    fs::remove(folder.state(), ignored);  // when the run was killed between its last two acts
    return {true, std::nullopt};
  }
  if (fs::exists(folder.frame(identity.at("first_frame").get<std::int64_t>()))) {
    refuse(folder, fmt::format("frames of {} but no record of their run", folder.name()),
           "start anew with --overwrite, or choose another folder with --out");
  }
  return {};
}

}  // namespace

Continuation find_continuation(const RunFolder& folder, const JournalContents& journal,
                               const sim::World& start, std::int64_t first_frame) {
  const Continuation from_the_start{first_frame, start, journal.header_end};
  const std::optional<sim::World> world = saved_world(folder, start);
  if (!world) return from_the_start;

  std::int64_t frame = first_frame;
  for (std::size_t i = 0; i < journal.lines.size(); ++i) {
    const Json& line = journal.lines[i];
    if (line.contains("launch")) continue;
    if (!is_whole(folder, line, frame)) break;
    ++frame;
    // The state is written after the line, so later lines may exist but no state for them.
    if (line.value("step", std::int64_t{-1}) != world->steps) continue;
    if (line.value("state_hash", "") != hex(sim::state_hash(*world))) break;
    return {frame, *world, journal.ends[i]};
  }
  return from_the_start;
}

OpenedFolder open_folder(const RunFolder& folder, ExistingRun existing, const Json& identity,
                         const std::string& scene_toml) {
  folder.make();
  const std::vector<std::string> runs = folder.runs();
  if (runs.empty()) {
    folder.remove_temporary_files();
    return {};
  }
  for (const std::string& run : runs) {
    if (is_in_use(RunFolder(folder.path(), run).journal())) {
      refuse(folder, fmt::format("a run of {} that is going on", run),
             "wait for it or choose another folder with --out");
    }
  }
  const std::string holds = fmt::format("a run of {}", fmt::join(runs, " and one of "));
  switch (existing) {
    case ExistingRun::overwrite:
      folder.remove_runs();
      return {};
    case ExistingRun::resume:
      if (runs != std::vector<std::string>{folder.name()}) {
        refuse(folder, holds,
               "only a run of the same scene can be continued; choose another folder "
               "with --out");
      }
      return continue_run(folder, identity, scene_toml);
    case ExistingRun::refuse:
      break;
  }
  refuse(folder, holds,
         "continue it with --resume, replace it with --overwrite, or choose another folder with "
         "--out");
}

}  // namespace pneuma::app
