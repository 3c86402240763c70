// The log of one run: what is in its folder, where the run goes on, and a line for all that
// happens.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/render/log/resume.h"
#include "app/render/log/run_record.h"

namespace pneuma::app {

class RunLog {
 public:
  /// Opens the folder for the run as `existing` says, and finds the frame from which it goes on.
  /// Throws base::IoError when the folder holds something else (see resume.h).
  RunLog(const RunFolder& folder, ExistingRun existing, const RunIdentity& run);

  /// The run has come to its end before: nothing below may be called but folder() and
  /// lost().
  bool finished() const { return !journal_; }
  /// Of a finished run: the record's lines of frames whose pictures are gone, in their order.
  const std::vector<Json>& lost() const { return lost_; }

  /// Nothing of it was there before.
  bool is_new() const { return is_new_; }

  const RunFolder& folder() const { return folder_; }
  /// The first frame that is still to be drawn, and the world at the one before it or at the start.
  std::int64_t next_frame() const { return next_frame_; }
  const sim::World& world() const { return world_; }
  /// What an automatic camera has seen of the run up to there; none: nothing but the start.
  const std::optional<render::ViewFit::Seen>& seen() const { return seen_; }
  /// The greatest values up to there of what its pictures show as colours.
  const FieldScale::Seen& fields_seen() const { return fields_seen_; }

  /// Each appends its line. They throw base::IoError.
  void append_launch(const std::vector<std::string>& command_line, const std::string& video,
                     int threads);
  void append_divergence(const std::string& message);
  /// Writes the world's state (sim/inspect/checkpoint.h) after the frame's line: whatever the
  /// moment of a kill, the state belongs to a frame that the journal knows.
  void append_frame(FrameState state, const PictureBytes& bytes, const FrameSeconds& seconds,
                    const std::vector<std::uint8_t>& checkpoint);

  /// Turns the journal into run.json, and removes it last: until then the run can be continued.
  void close();

 private:
  RunFolder folder_;
  bool is_new_ = false;
  std::int64_t next_frame_ = 0;
  sim::World world_;
  std::optional<render::ViewFit::Seen> seen_;
  FieldScale::Seen fields_seen_;
  std::vector<Json> lost_;
  std::optional<Journal> journal_;  // none: the run is finished
};

}  // namespace pneuma::app
