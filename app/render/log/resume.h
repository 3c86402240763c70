// What a folder holds of earlier runs, and where an interrupted one goes on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/picture/field_scale.h"
#include "app/render/log/journal.h"
#include "app/render/log/run_folder.h"
#include "render/frame/camera.h"
#include "sim/world/world.h"

namespace pneuma::app {

/// What to do when the folder already holds a run.
enum class ExistingRun { refuse, overwrite, resume };

/// What is there of a run that may go on.
struct OpenedFolder {
  bool finished = false;                      // nothing is left to be drawn
  std::optional<JournalContents> unfinished;  // none: the run starts from the beginning
  Json record = {};                           // of a finished run
  std::vector<Json> lost = {};                // its lines of frames whose pictures are gone
};

/// Makes the folder, and room for a run of this identity in it: removes an old run or finds the one
/// to continue, as `existing` says. It may go on to a later last frame; a finished one then becomes
/// unfinished again. One that diverged may go on with another [simulation] than it
/// had, and with other steps of those that diverge. Pictures that a finished run has lost can be
/// drawn again unless its settings changed on the way. Throws base::IoError when the folder holds
/// another run, or one that is going on, or pictures of no recorded run.
OpenedFolder open_folder(const RunFolder& folder, ExistingRun existing, const Json& identity,
                         const std::string& scene_toml);

struct Continuation {
  std::int64_t next_frame = 0;      // the first that is still to be drawn
  sim::World world;                 // at the frame before, or at the start
  std::uint64_t journal_bytes = 0;  // of the journal that hold
  std::string change;               // why the settings change here; empty: they do not
  // Of the run up to `world`: see RunCamera and FieldScale.
  std::optional<render::ViewFit::Seen> seen = {};
  FieldScale::Seen fields_seen = {};
};

/// The last frame for which picture, journal and saved state agree, with all frames before it
/// whole. Without a saved state, as of a finished run that is to have more frames, `world` is the
/// start, from which the steps are done again but only new frames are drawn. Where no frame agrees
/// the run begins again: its frames come out the same. Steps are counted
/// again where there are others to a frame than before.
Continuation find_continuation(const RunFolder& folder, const JournalContents& journal,
                               const Json& identity, const sim::World& start,
                               std::int64_t first_frame, int steps_per_frame);

}  // namespace pneuma::app
