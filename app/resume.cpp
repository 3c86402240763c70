#include "app/resume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>
#include <set>
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

/// The lines of two scenes that differ, by the table they are in. Scenes with the same bodies print
/// alike.
struct SceneDifferences {
  std::string text;        // up to three
  bool only_steps = true;  // none outside of [simulation]
};

SceneDifferences scene_differences(const std::string& then, const std::string& now) {
  std::istringstream old_lines(then), new_lines(now);
  SceneDifferences differences;
  std::string table;
  int count = 0;
  for (std::string a, b;;) {
    const bool more_old = static_cast<bool>(std::getline(old_lines, a));
    const bool more_new = static_cast<bool>(std::getline(new_lines, b));
    if (!more_old && !more_new) return differences;
    if (!more_old || !more_new) differences.only_steps = false;
    if (b.starts_with('[')) table = b.substr(0, b.find(']'));
    if (a == b) continue;
    differences.only_steps &= table.starts_with("[simulation");
    if (++count <= 3) differences.text += fmt::format("\n  was  {}\n  is   {}", a, b);
    if (count == 4) differences.text += "\n  ...";
  }
}

std::set<std::string> keys_of(const Json& a, const Json& b) {
  std::set<std::string> keys;
  for (const auto& [key, value] : a.items()) keys.insert(key);
  for (const auto& [key, value] : b.items()) keys.insert(key);
  return keys;
}

/// Why the run could not go on; empty when it was merely interrupted.
std::string divergence_of(const JournalContents& journal) {
  for (auto line = journal.lines.rbegin(); line != journal.lines.rend(); ++line) {
    if (line->contains("frame")) return "";
    if (line->contains("diverged")) return line->value("diverged", "");
  }
  return "";
}

/// Throws unless a run of the identity `now` continues the one of the header `then`. When that has
/// diverged, its steps may become others.
void require_same_run(const RunFolder& folder, const Json& then, const Json& now,
                      const std::string& scene_now, bool diverged) {
  const Json old = then.value("run", Json::object());
  if (old == now) return;
  std::string differences;
  for (const std::string& key : keys_of(old, now)) {
    const Json was = old.value(key, Json()), is = now.value(key, Json());
    if (was == is || (diverged && key == "on_divergence")) continue;
    if (key == "fingerprint") {
      const SceneDifferences scenes = scene_differences(then.value("scene_toml", ""), scene_now);
      if (diverged && scenes.only_steps) continue;
      differences += "\nthe scene or its settings:" + scenes.text;
    } else {
      differences += fmt::format("\n{}: was {}, is {}", key, was.dump(), is.dump());
    }
  }
  if (differences.empty()) return;
  throw render::IoError(
      fmt::format("the run in {} cannot be continued, because it differs from this one in{}\n"
                  "give the options it was started with{}, or --overwrite to start anew",
                  folder.path().string(), differences,
                  diverged ? " but for simulation.* and --on-divergence" : ""));
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
    const bool diverged = !divergence_of(*journal).empty();
    require_same_run(folder, present_header(*journal), identity, scene_toml, diverged);
    return {false, std::move(journal)};
  }
  if (fs::exists(folder.record())) {
    const auto bytes = render::read_file(folder.record().string());
    const Json record = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    require_same_run(folder, record, identity, scene_toml, false);
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
                               const Json& identity, const sim::World& start,
                               std::int64_t first_frame, int steps_per_frame) {
  // Settings that have changed already, after the frame from which the run now goes on, change
  // again.
  const auto change = [&](std::size_t lines) {
    JournalContents kept = journal;
    kept.lines.resize(lines);
    if (present_header(kept).value("run", Json()) == identity) return std::string();
    for (const Json& line : journal.lines) {
      if (line.contains("change")) return line.value("reason", "");
    }
    return divergence_of(journal);
  };
  const Continuation from_the_start{first_frame, start, journal.header_end, change(0)};
  const std::optional<sim::World> world = saved_world(folder, start);
  if (!world) return from_the_start;

  std::int64_t frame = first_frame;
  for (std::size_t i = 0; i < journal.lines.size(); ++i) {
    const Json& line = journal.lines[i];
    if (!line.contains("frame")) continue;
    if (!is_whole(folder, line, frame)) break;
    ++frame;
    // The state is written after the line, so later lines may exist but no state for them.
    if (line.value("step", std::int64_t{-1}) != world->steps) continue;
    if (line.value("state_hash", "") != hex(sim::state_hash(*world))) break;
    Continuation found{frame, *world, journal.ends[i], change(i + 1)};
    found.world.steps = (frame - 1) * steps_per_frame;
    return found;
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
