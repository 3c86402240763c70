#include "app/terminal/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "app/host/standard_streams.h"

namespace pneuma::app {
namespace {

constexpr auto terminal_interval = std::chrono::milliseconds(100);
constexpr auto line_interval = std::chrono::seconds(5);

/// "0:07", "2:03", "1:02:03".
std::string duration(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  const long long hours = whole / 3600, minutes = whole / 60 % 60;
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
  return fmt::format("{}:{:02}", minutes, whole % 60);
}

/// Of standard error now: people change the size of their windows. 0: not known.
int terminal_columns() {
  winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 ? int{size.ws_col} : 0;
}

std::string pace(const ProgressState& state) {
  return fmt::format("{:.2g} x real time", state.simulated / state.elapsed);
}

}  // namespace

std::string fitted_line(const std::string& text, int columns) {
  return columns > 0 ? text.substr(0, static_cast<std::size_t>(columns - 1)) : text;
}

std::string summary_line(const ProgressState& state) {
  constexpr double worth_a_word = 0.05;  // s
  const std::string before =
      state.look_ahead < worth_a_word
          ? ""
          : fmt::format(", after {:.1f} s of looking ahead for the camera", state.look_ahead);
  return fmt::format("{} frame{} in {:.1f} s: {:.3g} frames/s, {}{}", state.drawn,
                     state.drawn == 1 ? "" : "s", state.elapsed,
                     static_cast<double>(state.drawn) / state.elapsed, pace(state), before);
}

std::string progress_line(const ProgressState& state) {
  std::string line = fmt::format("frame {}/{}   t = {:.2f} s", state.frame, state.last, state.time);
  if (state.simulated > 0.0) line += "   " + pace(state);
  if (state.drawn > 0) {
    const auto left = static_cast<double>(state.last - state.frame);
    line += "   ETA " + duration(left * state.elapsed / static_cast<double>(state.drawn));
  }
  if (state.crossed > 0) {
    line +=
        fmt::format("   bodies cross in {} frame{}", state.crossed, state.crossed == 1 ? "" : "s");
  }
  return line;
}

Progress::~Progress() { clear_line(); }

void Progress::show(const std::string& text) {
  if (style_ == Style::silent) return;
  const std::lock_guard lock(mutex_);
  const bool terminal = style_ == Style::terminal;
  const Clock::time_point now = Clock::now();
  if (now - last_shown_ < (terminal ? Clock::duration(terminal_interval) : line_interval)) return;
  last_shown_ = now;
  if (terminal) {
    // Back to the start, the line, and clear what an older, longer one left behind it. A line that
    // filled a second row would leave the first behind each time.
    print_message("\r{}\x1b[K", fitted_line(text, terminal_columns()));
  } else {
    print_message("{}\n", text);
  }
  line_open_ = terminal;
}

void Progress::say(const std::string& text) {
  if (style_ == Style::silent) return;
  const std::lock_guard lock(mutex_);
  clear_line();
  print_message("{}\n", text);
}

void Progress::clear_line() {
  if (line_open_) print_message("\r\x1b[K");
  line_open_ = false;
}

Progress::Style progress_style(bool quiet) {
  if (quiet) return Progress::Style::silent;
  return isatty(STDERR_FILENO) != 0 ? Progress::Style::terminal : Progress::Style::lines;
}

}  // namespace pneuma::app
