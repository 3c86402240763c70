#include "app/terminal/progress.h"

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <thread>

namespace pneuma::app {
namespace {

TEST(ProgressLine, SaysFrameTimePaceAndRest) {
  const ProgressState state{
      .frame = 40, .last = 300, .time = 2.0, .elapsed = 4.0, .simulated = 1.0, .drawn = 20};
  // 20 frames took 4 s, so the other 260 take 52 s.
  EXPECT_EQ(progress_line(state), "frame 40/300   t = 2.00 s   0.25 x real time   ETA 0:52");
}

TEST(ProgressLine, WritesMinutesAndHours) {
  ProgressState state{
      .frame = 1, .last = 91, .time = 1.0, .elapsed = 2.0, .simulated = 1.0, .drawn = 1};
  EXPECT_NE(progress_line(state).find("ETA 3:00"), std::string::npos);
  state.last = 1801;
  EXPECT_NE(progress_line(state).find("ETA 1:00:00"), std::string::npos);
}

TEST(ProgressLine, SaysInHowManyFramesBodiesCross) {
  ProgressState state{.frame = 40, .last = 300, .time = 2.0, .crossed = 1};
  EXPECT_EQ(progress_line(state), "frame 40/300   t = 2.00 s   bodies cross in 1 frame");
  state.crossed = 12;
  EXPECT_EQ(progress_line(state), "frame 40/300   t = 2.00 s   bodies cross in 12 frames");
}

TEST(ProgressLine, SaysNothingThatItDoesNotKnow) {
  const ProgressState state{.frame = 0, .last = 300};
  EXPECT_EQ(progress_line(state), "frame 0/300   t = 0.00 s");
}

TEST(SummaryLine, SaysWhatItTook) {
  ProgressState state{
      .frame = 300, .last = 300, .time = 10.0, .elapsed = 40.0, .simulated = 10.0, .drawn = 301};
  EXPECT_EQ(summary_line(state), "301 frames in 40.0 s: 7.53 frames/s, 0.25 x real time");
  state.look_ahead = 1.26;
  EXPECT_EQ(summary_line(state),
            "301 frames in 40.0 s: 7.53 frames/s, 0.25 x real time, after 1.3 s of looking ahead "
            "for the camera");
}

TEST(FittedLine, LeavesTheLastColumnFree) {
  EXPECT_EQ(fitted_line("frame 42/300", 80), "frame 42/300");
  EXPECT_EQ(fitted_line("frame 42/300", 13), "frame 42/300");
  EXPECT_EQ(fitted_line("frame 42/300", 12), "frame 42/30");
  EXPECT_EQ(fitted_line("frame 42/300", 1), "");
  EXPECT_EQ(fitted_line("frame 42/300", 0), "frame 42/300");
}

/// Standard error is a terminal of so many columns meanwhile.
class Terminal {
 public:
  explicit Terminal(unsigned short columns) : before_(dup(STDERR_FILENO)) {
    winsize size = {24, columns, 0, 0};
    int slave = -1;
    is_there_ = openpty(&master_, &slave, nullptr, nullptr, &size) == 0;
    if (!is_there_) return;
    dup2(slave, STDERR_FILENO);
    close(slave);
  }
  ~Terminal() {
    if (!is_there_) return;
    dup2(before_, STDERR_FILENO);
    close(before_);
    close(master_);
  }
  /// Not in a bare system, which has no /dev/pts.
  bool is_there() const { return is_there_; }
  void narrow(unsigned short columns) const {
    const winsize size = {24, columns, 0, 0};
    EXPECT_EQ(ioctl(master_, TIOCSWINSZ, &size), 0);
  }
  /// What has come since.
  std::string shown() const {
    std::array<char, 1024> bytes;
    const ssize_t count = read(master_, bytes.data(), bytes.size());
    return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))};
  }

 private:
  int before_;
  int master_ = -1;
  bool is_there_ = false;
};

TEST(Progress, KeepsToOneRowOfATerminalThatGetsNarrower) {
  std::string wide, narrow;
  {
    const Terminal terminal(40);
    if (!terminal.is_there()) GTEST_SKIP() << "there are no pseudo-terminals here";
    Progress progress(Progress::Style::terminal);
    const auto show = [&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(150));
      progress.show("0123456789012345678901234567890123456789");
      return terminal.shown();
    };
    wide = show();
    terminal.narrow(20);
    narrow = show();
  }
  EXPECT_EQ(wide, "\r012345678901234567890123456789012345678\x1b[K");
  EXPECT_EQ(narrow, "\r0123456789012345678\x1b[K");
}

}  // namespace
}  // namespace pneuma::app
