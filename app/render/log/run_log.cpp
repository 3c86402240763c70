#include "app/render/log/run_log.h"

#include <filesystem>
#include <utility>

#include "scenes/loader/print_scene.h"
#include "sim/base/file.h"

namespace pneuma::app {

RunLog::RunLog(const RunFolder& folder, ExistingRun existing, const RunIdentity& run)
    : folder_(folder) {
  const Json identity = identity_json(run);
  const OpenedFolder opened =
      open_folder(folder, existing, identity, scenes::print_scene(run.scene));
  if (opened.finished) {
    lost_ = opened.lost;
    return;
  }

  const auto& old = opened.unfinished;
  is_new_ = !old;
  const Json header = old ? old->header : run_header(identity, run.scene);
  const int steps_per_frame = scenes::steps_per_frame(run.scene);
  Continuation from =
      old ? find_continuation(folder, *old, identity, run.start, run.frames.first, steps_per_frame)
          : Continuation{run.frames.first, run.start, 0, "", {}};
  next_frame_ = from.next_frame;
  world_ = std::move(from.world);
  seen_ = from.seen;
  fields_seen_ = from.fields_seen;

  journal_.emplace(folder.journal(), from.journal_bytes);
  if (!old) journal_->append(header);
  if (!from.change.empty()) {
    journal_->append(change_line(identity, run.scene, next_frame_, from.change));
  }
}

void RunLog::append_launch(const std::vector<std::string>& command_line, const std::string& video,
                           int threads) {
  journal_->append(launch_line(command_line, video, threads, next_frame_));
}

void RunLog::append_divergence(const std::string& message) {
  journal_->append(divergence_line(message));
}

void RunLog::append_frame(FrameState state, const PictureBytes& bytes, const FrameSeconds& seconds,
                          const std::vector<std::uint8_t>& checkpoint) {
  journal_->append(frame_line(std::move(state), bytes, seconds));
  base::write_file_atomically(folder_.state().string(), checkpoint);
}

void RunLog::close() {
  const auto journal = read_journal(folder_.journal());
  const std::string text = whole_record(journal.value()).dump(1) + "\n";
  base::write_file_atomically(folder_.record().string(),
                              {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  std::filesystem::remove(folder_.journal());
  std::filesystem::remove(folder_.state());
}

}  // namespace pneuma::app
