#include "app/render/log/resume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "app/record/world_json.h"
#include "app/render/log/run_record.h"
#include "sim/base/file.h"
#include "sim/inspect/checkpoint.h"
#include "sim/inspect/inspect.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

std::optional<sim::World> saved_world(const RunFolder& folder, const sim::World& start) {
  if (!fs::exists(folder.state())) return std::nullopt;
  sim::World world = start;
  try {
    sim::load_state(base::read_file(folder.state().string()), world);
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

std::int64_t last_frame_of(const Json& identity) {
  return identity.value("last_frame", std::int64_t{-1});
}

/// Whether the run of the identity `now` is that of `then` and goes on beyond its end.
bool extends(const Json& then, const Json& now) {
  Json same_end = then;
  same_end["last_frame"] = last_frame_of(now);
  return same_end == now && last_frame_of(now) > last_frame_of(then);
}

constexpr std::string_view more_frames = "more frames";

/// Whether the settings of its steps were changed on the way, other than by asking for more frames.
bool settings_changed(const JournalContents& journal) {
  return std::ranges::any_of(journal.lines, [](const Json& line) {
    return line.contains("change") && line.value("reason", "") != more_frames;
  });
}

/// Whether the frames that are there come out again when this run is stepped from the start.
bool steps_alike(const JournalContents& journal, const Json& identity) {
  const Json then = present_header(journal).value("run", Json::object());
  return !settings_changed(journal) && (then == identity || extends(then, identity));
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
    if (key == "last_frame" && last_frame_of(now) > last_frame_of(old)) continue;
    if (key == "fingerprint") {
      const SceneDifferences scenes = scene_differences(then.value("scene_toml", ""), scene_now);
      if (diverged && scenes.only_steps) continue;
      differences += "\nthe scene or its settings:" + scenes.text;
    } else {
      differences += fmt::format("\n{}: was {}, is {}", key, was.dump(), is.dump());
    }
  }
  if (differences.empty()) return;
  throw base::IoError(
      fmt::format("the run in {} cannot be continued, because it differs from this one in{}\n"
                  "give the options it was started with{}, with the same or a later last frame, or "
                  "--overwrite to start again",
                  folder.path().string(), differences,
                  diverged ? " but for simulation.* and --on-divergence" : ""));
}

[[noreturn]] void refuse(const RunFolder& folder, const std::string& holds,
                         const std::string& advice) {
  throw base::IoError(fmt::format("{} holds {}; {}", folder.path().string(), holds, advice));
}

/// Of a finished run: the lines of frames whose pictures have been lost since.
std::vector<Json> lost_frames(const RunFolder& folder, const Json& record) {
  std::vector<Json> lost;
  for (const Json& line : record.value("frames", Json::array())) {
    if (!is_whole(folder, line, line.value("frame", std::int64_t{-1}))) lost.push_back(line);
  }
  return lost;
}

/// The journal that a record was made of.
JournalContents journal_of(Json record) {
  JournalContents journal;
  for (const char* kind : {"launches", "changes", "frames"}) {
    for (const Json& line : record.value(kind, Json::array())) {
      const bool launch = kind == std::string_view("launches");
      journal.lines.push_back(launch ? Json{{"launch", line}} : line);
    }
    record.erase(kind);
  }
  record.erase("wall_seconds");
  record.erase("look_ahead_seconds");
  journal.header = std::move(record);
  return journal;
}

/// Throws unless a finished run can be stepped again: its settings stayed the same.
void require_one_kind_of_steps(const RunFolder& folder, const JournalContents& journal,
                               std::string_view purpose) {
  if (!settings_changed(journal)) return;
  refuse(folder,
         fmt::format("a finished run of {} whose settings changed on the way, which cannot be "
                     "stepped again {}",
                     folder.name(), purpose),
         "draw it again with --overwrite");
}

/// Makes an unfinished run of a finished one that is to have more frames. Its state is gone, so
/// that it is stepped again through the frames that are there: not possible when its steps were not
/// all of one kind.
std::optional<JournalContents> reopened(const RunFolder& folder, const Json& record) {
  const JournalContents journal = journal_of(record);
  require_one_kind_of_steps(folder, journal, "for more frames");
  std::string text = journal.header.dump() + "\n";
  for (const Json& line : journal.lines) text += line.dump() + "\n";
  base::write_file_atomically(folder.journal().string(),
                              {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  fs::remove(folder.record());  // from here on the journal says what is there
  return read_journal(folder.journal());
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
    const auto bytes = base::read_file(folder.record().string());
    const Json record = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    require_same_run(folder, record, identity, scene_toml, false);
    std::vector<Json> lost = lost_frames(folder, record);
    if (!lost.empty()) {
      require_one_kind_of_steps(
          folder, journal_of(record),
          fmt::format("for its lost frame {}", lost.front().value("frame", std::int64_t{-1})));
    }
    std::error_code ignored;
    fs::remove(folder.state(), ignored);  // when the run was killed between its last two acts
    if (extends(record.value("run", Json::object()), identity)) {
      return {false, reopened(folder, record)};
    }
    return {true, std::nullopt, record, std::move(lost)};
  }
  return {};
}

/// Throws where pictures are called as those of this run, which no record or journal says are
/// its own.
void require_no_pictures(const RunFolder& folder) {
  const std::vector<std::string> pictures = folder.pictures();
  if (pictures.empty()) return;
  refuse(folder,
         fmt::format("{}{}, but no record of a run of {}", pictures.front(),
                     pictures.size() > 1 ? fmt::format(", ..., {}", pictures.back()) : "",
                     folder.name()),
         "choose another folder with --out, or let the run replace those that it makes itself with "
         "--overwrite");
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
    const Json then = present_header(kept).value("run", Json());
    if (then == identity) return std::string();
    if (extends(then, identity)) return std::string(more_frames);
    for (const Json& line : journal.lines) {
      const std::string reason = line.contains("change") ? line.value("reason", "") : "";
      if (!reason.empty() && reason != more_frames) return reason;
    }
    return divergence_of(journal);
  };
  const Continuation from_the_start{first_frame, start, journal.header_end, change(0)};
  std::int64_t frame = first_frame;
  if (!fs::exists(folder.state()) && steps_alike(journal, identity)) {
    // All steps are of one kind, so that those from the start come to the same frames.
    Continuation again = from_the_start;
    for (std::size_t i = 0; i < journal.lines.size(); ++i) {
      if (!journal.lines[i].contains("frame")) continue;
      if (!is_whole(folder, journal.lines[i], frame)) break;
      again = {++frame, start, journal.ends[i], change(i + 1)};
    }
    return again;
  }
  const std::optional<sim::World> world = saved_world(folder, start);
  if (!world) return from_the_start;

  for (std::size_t i = 0; i < journal.lines.size(); ++i) {
    const Json& line = journal.lines[i];
    if (!line.contains("frame")) continue;
    if (!is_whole(folder, line, frame)) break;
    ++frame;
    // The state is written after the line, so later lines may exist but no state for them.
    if (line.value("step", std::int64_t{-1}) != world->steps) continue;
    if (line.value("state_hash", "") != hex(sim::state_hash(*world))) break;
    Continuation found{frame,         *world,        journal.ends[i],
                       change(i + 1), seen_in(line), fields_in(line)};
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
    if (existing != ExistingRun::overwrite) require_no_pictures(folder);
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
