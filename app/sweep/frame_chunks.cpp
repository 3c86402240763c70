#include "app/sweep/frame_chunks.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "app/host/clock.h"
#include "app/host/errors.h"
#include "app/study/study_folder.h"
#include "app/sweep/render_run.h"
#include "app/sweep/sweep_chunks.h"
#include "app/sweep/sweep_row.h"
#include "app/terminal/number_text.h"
#include "app/world/open_scene.h"
#include "sim/base/file.h"

namespace pneuma::app {
namespace {

namespace fs = std::filesystem;

constexpr int frames_to_measure = 12;

std::int64_t last_frame(const Sweep& sweep, std::int64_t run) {
  const SweepRun one = run_of(sweep, run);
  return scenes::frame_count(open_scene(one.scene_path, one.overrides(sweep)));
}

double seconds_of(const Sweep& sweep, const SweepRun& run, int last, const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  const auto start = Clock::now();
  render_run(sweep, run, fmt::format("0-{}", last), folder);
  const double seconds = seconds_since(start);
  fs::remove_all(folder, ignored);
  return seconds;
}

/// The same file under a second name or, where the file system has none, a copy.
void link_or_copy(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::remove(to, error);
  fs::create_hard_link(from, to, error);
  if (error) fs::copy_file(from, to, fs::copy_options::overwrite_existing, error);
  if (error) throw base::IoError(fmt::format("cannot write {}: {}", to.string(), error.message()));
}

}  // namespace

FrameChunk parse_frame_chunk(const std::string& text, const Sweep& sweep) {
  const std::size_t colon = text.find(':');
  const std::string frames = colon == std::string::npos ? std::string() : text.substr(colon + 1);
  const std::size_t dash = frames.find('-');
  const auto run = whole_number(std::string_view(text).substr(0, colon));
  const auto first = whole_number(std::string_view(frames).substr(0, dash));
  const auto last = dash == std::string::npos
                        ? std::nullopt
                        : whole_number(std::string_view(frames).substr(dash + 1));
  if (!run || !first || !last) {
    throw UsageError(fmt::format("--frames {}: give run and frames, as 3:120-179", text));
  }
  parse_runs(text.substr(0, colon), sweep, "--frames");
  const FrameChunk chunk{*run, *first, *last};
  if (chunk.first <= chunk.last) return chunk;
  throw UsageError(fmt::format("--frames {}: the last frame comes before the first", text));
}

void draw_frame_chunk(const Sweep& sweep, const FrameChunk& chunk, const fs::path& folder) {
  const std::string frames = fmt::format("{}-{}", chunk.first, chunk.last);
  const fs::path part = picture_folder(folder, chunk.run) / frames;
  const SweepRun run = run_of(sweep, chunk.run);
  try {
    render_run(sweep, run, frames, part);
  } catch (const base::IoError&) {
    const SweepRow row = run_one(sweep, run, {});
    if (came_to_its_end(row) || is_to_be_repeated(row)) throw;
    fs::remove_all(part);
    const nlohmann::json why = {{"no_pictures", row.words}};
    StudyFolder(part).write("run.json", why.dump(2) + '\n');
  }
}

void join_frame_chunks(const SweepRows& rows, const fs::path& folder) {
  std::error_code ignored;
  for (const auto& [number, row] : rows) {
    if (!came_to_its_end(row)) continue;
    const fs::path whole = picture_folder(folder, number);
    for (const auto& part : fs::directory_iterator(whole, ignored)) {
      if (!part.is_directory()) continue;
      for (const auto& file : fs::directory_iterator(part.path())) {
        if (file.path().extension() != ".png") continue;
        link_or_copy(file.path(), whole / file.path().filename());
      }
    }
  }
}

DrawingCost measure_drawing(const Sweep& sweep, const SweepRun& run, const fs::path& folder) {
  const fs::path trial = folder / fmt::format("measured-{}.tmp", getpid());  // nobody else's
  const double one = seconds_of(sweep, run, 0, trial);
  const double many = seconds_of(sweep, run, frames_to_measure, trial);
  const double frame = std::max(1e-4, (many - one) / frames_to_measure);
  return {.start = std::max(0.0, one - frame), .frame = frame};
}

std::vector<FrameChunk> make_frame_chunks(const Sweep& sweep, const std::vector<double>& simulation,
                                          const DrawingCost& drawing, double most_seconds) {
  std::vector<FrameChunk> chunks;
  for (std::int64_t run = 0; run < run_count(sweep); ++run) {
    const double simulated = simulation[static_cast<std::size_t>(run)];
    if (simulated == 0.0) continue;
    const std::int64_t frames = last_frame(sweep, run) + 1;
    // The last part simulates all of the run.
    const double for_drawing =
        std::max(0.25 * most_seconds, most_seconds - simulated - drawing.start);
    const double parts = std::ceil(static_cast<double>(frames) * drawing.frame / for_drawing);
    const std::int64_t count =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(parts), 1, frames);
    for (std::int64_t i = 0; i < count; ++i) {
      chunks.push_back({run, frames * i / count, frames * (i + 1) / count - 1});
    }
  }
  return chunks;
}

double simulated_again(const std::vector<FrameChunk>& chunks, const Sweep& sweep,
                       const std::vector<double>& simulation) {
  double seconds = 0.0;
  for (const FrameChunk& chunk : chunks) {
    const double frames = static_cast<double>(last_frame(sweep, chunk.run));
    seconds += simulation[static_cast<std::size_t>(chunk.run)] * static_cast<double>(chunk.first) /
               std::max(1.0, frames);
  }
  return seconds;
}

}  // namespace pneuma::app
