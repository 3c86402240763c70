// How far a run has come, for people, on standard error.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "app/host/clock.h"

namespace pneuma::app {

/// One moment of a run.
struct ProgressState {
  std::int64_t frame = 0;  // finished
  std::int64_t last = 0;
  double time = 0.0;         // simulated so far, s
  double elapsed = 0.0;      // s since the launch, without the next
  double look_ahead = 0.0;   // s for which the first frame waited until its camera was known
  double simulated = 0.0;    // s of the scene's time since the launch
  std::int64_t drawn = 0;    // frames since the launch
  std::int64_t crossed = 0;  // of these, in which bodies pass through each other
};

/// "frame 42/300   t = 1.40 s   2.1 x real time   ETA 2:03", and in how many frames
/// bodies cross, if any.
std::string progress_line(const ProgressState& state);

/// "301 frames in 43.0 s: 7 frames/s, 0.23 x real time".
std::string summary_line(const ProgressState& state);

/// The beginning of a line that a terminal of so many columns shows in one row, its last column
/// left free; all of it where the width is not known (0).
std::string fitted_line(const std::string& text, int columns);

/// A single line that is written over on a terminal; elsewhere a plain line every few seconds.
/// Several threads may call it.
class Progress {
 public:
  enum class Style { silent, terminal, lines };

  explicit Progress(Style style) : style_(style) {}
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Not more often than is good for the reader.
  void show(const std::string& text);
  /// A line that stays.
  void say(const std::string& text);

 private:
  void clear_line();

  Style style_;
  std::mutex mutex_;
  bool line_open_ = false;
  Clock::time_point last_shown_ = Clock::now();
};

/// As standard error is: a terminal or not.
Progress::Style progress_style(bool quiet);

}  // namespace pneuma::app
