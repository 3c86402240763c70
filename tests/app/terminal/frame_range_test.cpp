#include "app/terminal/frame_range.h"

#include <gtest/gtest.h>

#include "app/host/errors.h"

namespace pneuma::app {
namespace {

TEST(ParseFrames, TakesACountAPartOrAnEnd) {
  EXPECT_EQ(parse_frames("30").first, 0);
  EXPECT_EQ(parse_frames("30").last, 29);
  EXPECT_EQ(parse_frames("10-20").first, 10);
  EXPECT_EQ(parse_frames("10-20").last, 20);
  EXPECT_EQ(parse_frames("7-7").last, 7);
  EXPECT_EQ(parse_frames("10-").first, 10);
  EXPECT_EQ(parse_frames("10-").last, std::nullopt);
}

TEST(ParseFrames, RefusesEverythingElse) {
  for (const char* wrong : {"", "0", "-1", "-", "20-10", "1-2-3", "1..2", "a", "3 ", "1.5", "+3",
                            "99999999999999999999", "1--2", "0x10"}) {
    EXPECT_THROW(parse_frames(wrong), UsageError) << wrong;
  }
}

}  // namespace
}  // namespace pneuma::app
