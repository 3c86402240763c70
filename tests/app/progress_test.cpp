#include "app/progress.h"

#include <gtest/gtest.h>

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

TEST(ProgressLine, SaysNothingThatItDoesNotKnow) {
  const ProgressState state{.frame = 0, .last = 300};
  EXPECT_EQ(progress_line(state), "frame 0/300   t = 0.00 s");
}

TEST(SummaryLine, SaysWhatItTook) {
  const ProgressState state{
      .frame = 300, .last = 300, .time = 10.0, .elapsed = 40.0, .simulated = 10.0, .drawn = 301};
  EXPECT_EQ(summary_line(state), "301 frames in 40.0 s: 7.53 frames/s, 0.25 x real time");
}

}  // namespace
}  // namespace pneuma::app
